#include "table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>

namespace nonobtuse::tool {
namespace {

constexpr int kLabelWidth = 34;
constexpr int kColumnWidth = 12;

using Cell = std::function<std::string(const Column&)>;

std::string row(const std::string& label, const std::vector<Column>& columns, const Cell& cell) {
  std::string line = fmt::format("  {:<{}}", label, kLabelWidth);
  for (const Column& column : columns) line += fmt::format("{:>{}}", cell(column), kColumnWidth);
  return line + "\n";
}

Cell figure(double AngleQuality::*member, int digits) {
  return [=](const Column& c) { return fmt::format("{:.{}f}", c.angles.*member, digits); };
}

Cell relative_distance(double SurfaceDistance::*member, double unit) {
  return [=](const Column& c) {
    if (!c.distance) return std::string("-");
    const double diagonal = c.distance->diagonal;
    return fmt::format("{:.3f}", diagonal > 0 ? (*c.distance).*member / diagonal / unit : 0.0);
  };
}

// The bounds as an interval, without trailing zeros.
std::string interval(const CertificateBounds& bounds) {
  return fmt::format("[{:g}, {:g})", bounds.min_angle, bounds.max_angle);
}

// Triangles of both lists, the worst of each in turn, none twice.
std::vector<Index> worst_triangles(const Certificate& certificate, Index count) {
  std::vector<Index> worst;
  const auto add = [&](const std::vector<Index>& list, std::size_t k) {
    if (k < list.size() && worst.size() < static_cast<std::size_t>(count) &&
        std::find(worst.begin(), worst.end(), list[k]) == worst.end())
      worst.push_back(list[k]);
  };
  const std::size_t longest = std::max(certificate.too_large.size(), certificate.too_small.size());
  for (std::size_t k = 0; k < longest && worst.size() < static_cast<std::size_t>(count); ++k) {
    add(certificate.too_large, k);
    add(certificate.too_small, k);
  }
  return worst;
}

}  // namespace

std::string quality_table(const std::vector<Column>& columns) {
  const auto count = [](auto value) { return fmt::format("{}", value); };
  std::string text;
  if (columns.size() > 1) text = row("", columns, [](const Column& c) { return c.title; });
  text += row("vertices", columns, [&](const Column& c) { return count(c.vertices); });
  text += row("triangles", columns, [&](const Column& c) { return count(c.angles.triangles); });
  text += row("obtuse triangles", columns, [&](const Column& c) { return count(c.angles.obtuse); });
  text += row("Q_min (1 = equilateral)", columns, figure(&AngleQuality::quality_min, 3));
  text += row("Q_avg", columns, figure(&AngleQuality::quality_mean, 3));
  text += row("smallest angle, degrees", columns, figure(&AngleQuality::min_angle, 2));
  text += row("mean smallest angle", columns, figure(&AngleQuality::mean_min_angle, 2));
  text += row("largest angle", columns, figure(&AngleQuality::max_angle, 2));
  text += row("% of triangles with angle < 30", columns, figure(&AngleQuality::percent_small, 2));
  text += row("% of triangles with angle >= 90", columns, figure(&AngleQuality::percent_obtuse, 2));
  text += row("% of vertices of valence 5, 6, 7", columns,
              figure(&AngleQuality::percent_valence_567, 2));
  if (std::any_of(columns.begin(), columns.end(),
                  [](const Column& c) { return c.distance.has_value(); })) {
    text +=
        row("d_RMS, 1e-3 of the diagonal", columns, relative_distance(&SurfaceDistance::rms, 1e-3));
    text += row("d_H,   1e-2 of the diagonal", columns,
                relative_distance(&SurfaceDistance::hausdorff, 1e-2));
  }
  return text;
}

std::string topology_table(const QualityReport& report, bool with_reference) {
  const Topology& t = report.topology;
  const auto line = [](const char* label, long long value) {
    return fmt::format("  {:<{}}{:>{}}\n", label, kLabelWidth, value, kColumnWidth);
  };
  std::string text = line("edges", t.edges) + line("components", t.components) +
                     line("Euler characteristic", t.euler_characteristic) +
                     line("boundary loops", t.boundary_loops) +
                     line("non-manifold edges", t.nonmanifold_edges) +
                     line("non-manifold vertices", t.nonmanifold_vertices);
  text += fmt::format("  {:<{}}{:>{}}\n", "consistently oriented", kLabelWidth,
                      t.oriented ? "yes" : "no", kColumnWidth);
  text += line("self-intersecting pairs", report.self_intersections);
  if (with_reference) text += line("flipped triangles", report.flipped);
  return text;
}

std::string repairs_text(const std::string& path, const std::vector<Repair>& repairs) {
  std::string text;
  for (const Repair& repair : repairs) {
    text += fmt::format("{}: {} {}", path, repair.count, repair.what);
    if (repair.first >= 0) text += fmt::format(" (first: number {})", repair.first);
    text += "\n";
  }
  return text;
}

TriangleAngles angles_of(const TriangleMesh& mesh, Index triangle) {
  const Triangle& t = mesh.triangles[triangle];
  std::array<double, 3> angles{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& p = mesh.vertices[t[k]];
    const Vec3& q = mesh.vertices[t[(k + 1) % 3]];
    const Vec3& r = mesh.vertices[t[(k + 2) % 3]];
    const Vec3 u{q.x - p.x, q.y - p.y, q.z - p.z};
    const Vec3 v{r.x - p.x, r.y - p.y, r.z - p.z};
    const Vec3 n{u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
    angles[k] = std::atan2(std::hypot(n.x, n.y, n.z), u.x * v.x + u.y * v.y + u.z * v.z) * 180 /
                std::numbers::pi;
  }
  const auto [smallest, largest] = std::minmax_element(angles.begin(), angles.end());
  return {*smallest, *largest};
}

std::string certificate_text(const std::string& path, const TriangleMesh& mesh,
                             const Certificate& certificate, Index worst) {
  if (certificate.certified)
    return fmt::format(
        "certified: every angle of {} is in {} degrees ({} triangles, decided exactly on the "
        "coordinates in the file)\n",
        path, interval(certificate.bounds), certificate.triangles);
  if (certificate.triangles == 0) return fmt::format("not certified: {} has no triangle\n", path);
  std::string text = fmt::format(
      "not certified: {} of {} triangles of {} have an angle of {:g} degrees or more, {} one below "
      "{:g}\n",
      certificate.too_large.size(), certificate.triangles, path, certificate.bounds.max_angle,
      certificate.too_small.size(), certificate.bounds.min_angle);
  for (const Index t : worst_triangles(certificate, worst)) {
    const TriangleAngles angles = angles_of(mesh, t);
    const Vec3& p = mesh.vertices[mesh.triangles[t][0]];
    text += fmt::format("  triangle {}: angles from {:.4f} to {:.4f}, at ({:g}, {:g}, {:g})\n", t,
                        angles.smallest, angles.largest, p.x, p.y, p.z);
  }
  return text;
}

}  // namespace nonobtuse::tool
