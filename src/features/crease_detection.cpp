#include "features/crease_detection.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace nonobtuse::features {

namespace {

// Angles between the normals of two facets, by their cosines.
constexpr double kCos15 = 0.96592582628906829;
constexpr double kCos20 = 0.93969262078590839;
constexpr double kCosFlat = 0.9986;  // 3 degrees
constexpr double kCos40 = 0.76604444311897804;
constexpr double kCos60 = 0.5;
constexpr double kDegree = 3.14159265358979323846 / 180;

// A smooth surface has several times as many edges of 20 to 40 degrees as above; one with creases
// has many fewer.
constexpr double kMostBlunt = 0.75;
// Or there is some range of angles of this half-width in degrees with hardly any edges.
constexpr double kHalfGap = 7.5;
constexpr double kMostInGap = 0.2;
// A regular polyhedron of blunt edges, such as an icosahedron, is a coarse sphere.
constexpr double kMostSharp = 0.8;
// A blunter edge continues a crease if it turns this many times as much as the edges beside it.
constexpr double kContrast = 3;
constexpr double kChamferContrast = 2;
constexpr double kCosStraight = 0.8;  // and lies nearly in the direction of the crease

struct Side {
  Index facet;
  int k;
};

class Detector {
 public:
  Detector(const mesh::Surface& surface, EdgeFlags& flags) : surface_(surface), flags_(flags) {}

  void run() {
    const double sharp = sharp_cosine();
    for_each_edge([&](Side e, double c) {
      if (c <= std::min(sharp, kCos60)) flag(e);
    });
    // Of edges that turn by less than 60 degrees those of a prism's round side are no creases;
    // one edge of a chamfer has a flat side.
    std::vector<Side> fine;
    for_each_edge([&](Side e, double c) {
      if (c <= sharp && c > kCos60 &&
          std::acos(c) >= kChamferContrast * std::min(turn_beside(e, e), turn_beside(e, twin(e))))
        fine.push_back(e);
    });
    for (const Side e : fine) flag(e);
    grow();
    drop_single_edges();
  }

 private:
  // Cosine of the angle by which the normal turns; 1 at boundaries and beside facets without area.
  [[nodiscard]] double cosine(Side e) const {
    const Index other = surface_.adjacent[e.facet][e.k];
    if (other < 0 || surface_.areas[e.facet] == 0 || surface_.areas[other] == 0) return 1;
    return dot(surface_.normals[e.facet], surface_.normals[other]);
  }

  template <class Visit>
  void for_each_edge(const Visit& visit) const {
    for (Index f = 0; f < static_cast<Index>(surface_.triangles.size()); ++f)
      for (int k = 0; k < 3; ++k)
        if (surface_.adjacent[f][k] > f) visit(Side{f, k}, cosine({f, k}));
  }

  // The cosine up to which edges are sharp; -2 if none are. On a smooth surface the edges get
  // gradually fewer with their angle; where there are creases, they leave a gap.
  [[nodiscard]] double sharp_cosine() const {
    std::vector<double> cosines;
    for_each_edge([&](Side, double c) { cosines.push_back(c); });
    std::sort(cosines.begin(), cosines.end());
    const auto from = [&](double degrees) {  // edges that turn by as much or more
      const double c = std::cos(degrees * kDegree);
      return static_cast<double>(std::upper_bound(cosines.begin(), cosines.end(), c) -
                                 cosines.begin());
    };
    const auto all = static_cast<double>(cosines.size());
    const double sharp = from(40);
    if (sharp == 0 || (sharp > kMostSharp * all && 2 * from(60) < sharp)) return -2;
    if (from(20) - sharp <= kMostBlunt * sharp) return kCos40;
    for (double gap = 35; gap < 60; gap += 2.5) {
      const double above = from(gap + kHalfGap);
      if (above > 0 && from(gap - kHalfGap) - above <= kMostInGap * above)
        return std::cos((gap + kHalfGap) * kDegree);
    }
    return -2;
  }

  [[nodiscard]] Side twin(Side e) const {
    const Index g = surface_.adjacent[e.facet][e.k];
    if (g < 0) return {-1, 0};
    for (int l = 0; l < 3; ++l)
      if (surface_.adjacent[g][l] == e.facet && head({g, l}) == tail(e)) return {g, l};
    return {-1, 0};
  }
  [[nodiscard]] Index tail(Side e) const { return surface_.triangles[e.facet][mesh::next(e.k)]; }
  [[nodiscard]] Index head(Side e) const {
    return surface_.triangles[e.facet][mesh::previous(e.k)];
  }
  [[nodiscard]] Vec3 direction(Side e) const {
    return normalized(surface_.vertices[head(e)] - surface_.vertices[tail(e)]);
  }

  void flag(Side e) {
    set_flag(flags_, e.facet, e.k);
    if (const Side o = twin(e); o.facet >= 0) set_flag(flags_, o.facet, o.k);
  }

  // The most that the normal turns at edges beside e, as far as they run along it: those of the
  // two rings of facets behind `s`, one side of it, that do not touch e and are not creases.
  [[nodiscard]] double turn_beside(Side e, Side s) const {
    const Vec3 d = direction(e);
    const Index a = tail(e);
    const Index b = head(e);
    double most = 0;
    if (s.facet < 0) return most;
    for (const int j : {mesh::next(s.k), mesh::previous(s.k)}) {
      const Side across = twin({s.facet, j});
      if (across.facet < 0 || flagged(flags_, s.facet, j)) continue;
      for (const int l : {mesh::next(across.k), mesh::previous(across.k)}) {
        const Side f{across.facet, l};
        if (flagged(flags_, f.facet, f.k) || tail(f) == a || tail(f) == b || head(f) == a ||
            head(f) == b)
          continue;
        most = std::max(most, std::abs(dot(direction(f), d)) * std::acos(std::min(1.0, cosine(f))));
      }
    }
    return most;
  }

  // Creases that end are continued over blunter edges.
  void grow() {
    std::vector<Index> degree(surface_.vertices.size(), 0);
    std::vector<std::vector<Side>> at(surface_.vertices.size());
    std::vector<Index> ends;
    for (Index f = 0; f < static_cast<Index>(surface_.triangles.size()); ++f)
      for (int k = 0; k < 3; ++k) {
        const Index g = surface_.adjacent[f][k];
        if (g >= 0 && g < f) continue;
        const Side e{f, k};
        const bool crease = flagged(flags_, f, k) || g < 0;
        if (!crease && cosine(e) > kCos15) continue;
        for (const Index v : {tail(e), head(e)}) {
          at[v].push_back(e);
          if (crease) ++degree[v];
        }
      }
    for (Index v = 0; v < static_cast<Index>(degree.size()); ++v)
      if (degree[v] == 1) ends.push_back(v);
    while (!ends.empty()) {
      const Index v = ends.back();
      ends.pop_back();
      if (degree[v] != 1) continue;
      const auto outwards = [&](Side e) {
        return tail(e) == v ? direction(e) : -1.0 * direction(e);
      };
      const auto last = std::find_if(at[v].begin(), at[v].end(), [&](Side e) {
        return flagged(flags_, e.facet, e.k) || surface_.adjacent[e.facet][e.k] < 0;
      });
      const Vec3 onwards = -1.0 * outwards(*last);
      const Side* best = nullptr;
      double straightest = kCosStraight;
      for (const Side& e : at[v]) {
        if (flagged(flags_, e.facet, e.k) || surface_.adjacent[e.facet][e.k] < 0) continue;
        const double straight = dot(outwards(e), onwards);
        const double beside = std::max(turn_beside(e, e), turn_beside(e, twin(e)));
        if (straight <= straightest || std::acos(cosine(e)) < kContrast * beside) continue;
        straightest = straight;
        best = &e;
      }
      if (best == nullptr) continue;
      flag(*best);
      const Index w = tail(*best) == v ? head(*best) : tail(*best);
      ++degree[v];
      if (++degree[w] == 1) ends.push_back(w);
    }
  }

  // An edge that continues nowhere is no curve.
  void drop_single_edges() {
    std::vector<Index> degree(surface_.vertices.size(), 0);
    for (Index f = 0; f < static_cast<Index>(surface_.triangles.size()); ++f)
      for (int k = 0; k < 3; ++k)
        if (surface_.adjacent[f][k] < f && (flagged(flags_, f, k) || surface_.adjacent[f][k] < 0)) {
          ++degree[tail({f, k})];
          ++degree[head({f, k})];
        }
    for (Index f = 0; f < static_cast<Index>(surface_.triangles.size()); ++f)
      for (int k = 0; k < 3; ++k)
        if (flagged(flags_, f, k) && degree[tail({f, k})] == 1 && degree[head({f, k})] == 1)
          flags_[f] = static_cast<std::uint8_t>(flags_[f] & ~(1 << k));
  }

  const mesh::Surface& surface_;
  EdgeFlags& flags_;
};

}  // namespace

void detect_creases(const mesh::Surface& surface, EdgeFlags& flags) {
  EdgeFlags creases(flags.size(), 0);
  Detector(surface, creases).run();
  for (std::size_t f = 0; f < flags.size(); ++f)
    flags[f] = static_cast<std::uint8_t>(flags[f] | creases[f]);
}

namespace {

// How far the flat place around `facet` reaches from the line through a in direction d, if that is
// less than `most`.
double flat_width(const mesh::Surface& surface, const EdgeFlags& flags, Index facet, const Vec3& a,
                  const Vec3& d, double most, std::vector<Index>& seen) {
  const Vec3 normal = surface.normals[facet];
  std::vector<Index> stack{facet};
  seen.assign(1, facet);
  double width = 0;
  while (!stack.empty() && width < most) {
    const Index f = stack.back();
    stack.pop_back();
    for (int k = 0; k < 3; ++k) {
      const Vec3 out = surface.vertices[surface.triangles[f][k]] - a;
      width = std::max(width, length(out - dot(out, d) * d));
      const Index g = surface.adjacent[f][k];
      if (g < 0 || flagged(flags, f, k) || dot(surface.normals[g], normal) < kCosFlat) continue;
      const auto at = std::lower_bound(seen.begin(), seen.end(), g);
      if (at != seen.end() && *at == g) continue;
      seen.insert(at, g);
      stack.push_back(g);
    }
  }
  return width;
}

}  // namespace

void flag_coarse_creases(const mesh::Surface& surface, double width, EdgeFlags& flags) {
  std::vector<Index> seen;
  bool any = false;
  for (Index f = 0; f < static_cast<Index>(flags.size()) && !any; ++f)
    for (int k = 0; k < 3; ++k) any = any || (flagged(flags, f, k) && surface.adjacent[f][k] >= 0);
  if (!any) return;
  EdgeFlags added = flags;
  for (Index f = 0; f < static_cast<Index>(flags.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const Index g = surface.adjacent[f][k];
      if (g < 0 || flagged(flags, f, k) || dot(surface.normals[f], surface.normals[g]) > kCos20)
        continue;
      const Triangle& t = surface.triangles[f];
      const Vec3 a = surface.vertices[t[mesh::next(k)]];
      const Vec3 d = normalized(surface.vertices[t[mesh::previous(k)]] - a);
      if (flat_width(surface, flags, f, a, d, width, seen) >= width &&
          flat_width(surface, flags, g, a, d, width, seen) >= width)
        set_flag(added, f, k);
    }
  flags = std::move(added);
}

void flag_dihedral_angles(const mesh::Surface& surface, double degrees, EdgeFlags& flags) {
  const double most = std::cos(degrees * 3.14159265358979323846 / 180);
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const Index g = surface.adjacent[f][k];
      if (g >= 0 && surface.areas[f] > 0 && surface.areas[g] > 0 &&
          dot(surface.normals[f], surface.normals[g]) <= most)
        set_flag(flags, f, k);
    }
}

}  // namespace nonobtuse::features
