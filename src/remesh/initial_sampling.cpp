#include "remesh/initial_sampling.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "numeric/random.h"
#include "rvd/facet_pieces.h"

namespace nonobtuse::pipeline {

namespace {
constexpr Index kFewestSites = 4;  // of a closed mesh
}

Components connected_components(const mesh::Surface& surface) {
  Components result;
  const auto facets = static_cast<Index>(surface.triangles.size());
  result.of_triangle.assign(facets, -1);
  std::vector<Index> seen(surface.vertices.size(), -1);  // last component that met the vertex
  std::vector<Index> stack;
  for (Index seed = 0; seed < facets; ++seed) {
    if (result.of_triangle[seed] >= 0) continue;
    const Index c = result.count();
    double area = 0;
    double boundary = 0;
    Index vertices = 0;
    Index triangles = 0;
    Index half_edges = 0;  // interior edges count twice
    Index open = 0;
    result.of_triangle[seed] = c;
    stack.assign(1, seed);
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      area += surface.areas[t];
      ++triangles;
      for (int k = 0; k < 3; ++k) {
        const Triangle& v = surface.triangles[t];
        if (seen[v[k]] != c) {
          seen[v[k]] = c;
          ++vertices;
        }
        const Index other = surface.adjacent[t][k];
        if (other < 0) {
          ++open;
          boundary +=
              distance(surface.vertices[v[mesh::next(k)]], surface.vertices[v[mesh::previous(k)]]);
        } else {
          ++half_edges;
          if (result.of_triangle[other] < 0) {
            result.of_triangle[other] = c;
            stack.push_back(other);
          }
        }
      }
    }
    result.area.push_back(area);
    result.euler.push_back(vertices - (half_edges / 2 + open) + triangles);
    result.boundary_length.push_back(boundary);
  }
  return result;
}

std::vector<Index> share_sites(const Components& components, Index sites,
                               std::span<const Index> least) {
  const Index count = components.count();
  const auto needed = [&](Index c) { return least.empty() ? kFewestSites : least[c]; };
  std::vector<Index> quota(count, -1);
  std::vector<Index> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return components.area[a] > components.area[b]; });
  Index left = sites;
  Index left_needed = 0;
  double area_left = 0;
  for (Index c = 0; c < count; ++c) {
    left_needed += needed(c);
    area_left += components.area[c];
  }
  if (left < left_needed) {  // not enough for all: the largest come first
    for (const Index c : order) {
      quota[c] = std::min(left, needed(c));
      left -= quota[c];
    }
    return quota;
  }
  // Components whose share by area is below their need get that; the others divide what is left.
  const auto share = [&](Index c) {
    return area_left > 0 ? left * (components.area[c] / area_left) : 0.0;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (Index k = count; k-- > 0;) {
      const Index c = order[k];
      if (quota[c] >= 0 || share(c) >= needed(c)) continue;
      quota[c] = needed(c);
      left -= quota[c];
      area_left -= components.area[c];
      changed = true;
    }
  }
  std::vector<double> remainder(count, -1);
  Index given = 0;
  for (const Index c : order) {
    if (quota[c] >= 0) continue;
    quota[c] = std::min(static_cast<Index>(share(c)), left - given);
    remainder[c] = share(c) - quota[c];
    given += quota[c];
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return remainder[a] > remainder[b]; });
  for (Index k = 0; given < left; k = (k + 1) % count, ++given) ++quota[order[k]];
  return quota;
}

SampledSites sample_strata(const mesh::Surface& surface, const Components& components,
                           const std::vector<Index>& quota, std::uint64_t seed) {
  const Index total = std::accumulate(quota.begin(), quota.end(), Index{0});
  const rvd::FacetPieces pieces = rvd::facet_pieces(surface, std::max<Index>(total, 1));
  SampledSites result;
  result.points.reserve(total);
  result.component.reserve(total);
  std::vector<Index> drawn(components.count(), 0);
  std::vector<double> passed(components.count(), 0);
  // With sizing, strata hold equal integrals of rho^(1/2) instead of equal areas.
  std::vector<double> whole = components.area;
  if (!pieces.uniform()) {
    whole.assign(components.count(), 0);
    for (Index p = 0; p < pieces.count(); ++p)
      whole[components.of_triangle[pieces.facet[p]]] += rvd::sites_of(pieces, p);
  }
  std::vector<double> target(components.count());
  std::vector<Index> last(components.count(), -1);  // last piece with area
  // Stream of random numbers: component and sample, so that no sample depends on another.
  const auto stream = [&](Index c) {
    return numeric::Random(seed, (static_cast<std::uint64_t>(c) << 32) + drawn[c]);
  };
  const auto next_target = [&](Index c) {
    target[c] = (drawn[c] + stream(c).uniform()) / std::max<Index>(quota[c], 1) * whole[c];
  };
  const auto draw = [&](Index c, Index piece) {
    numeric::Random random = stream(c);
    random.next();
    double a = random.uniform();
    double b = random.uniform();
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    const std::array<Vec3, 3> v = pieces.corners_of(piece);
    result.points.push_back((1 - a - b) * v[0] + a * v[1] + b * v[2]);
    result.component.push_back(c);
    ++drawn[c];
    next_target(c);
  };
  for (Index c = 0; c < components.count(); ++c) next_target(c);
  for (Index p = 0; p < pieces.count(); ++p) {
    const Index c = components.of_triangle[pieces.facet[p]];
    passed[c] += rvd::sites_of(pieces, p);
    if (pieces.area[p] > 0 || last[c] < 0) last[c] = p;
    while (drawn[c] < quota[c] && target[c] <= passed[c]) draw(c, p);
  }
  // Rounding may leave the last stratum's sample beyond the summed area.
  for (Index c = 0; c < components.count(); ++c)
    while (drawn[c] < quota[c]) draw(c, last[c]);
  return result;
}

}  // namespace nonobtuse::pipeline
