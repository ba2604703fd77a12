// The decision itself is numeric/predicates; see AngleBounds for the safe side of other bounds.
#include "nonobtuse/certificate.h"

#include <algorithm>
#include <utility>

#include "nonobtuse/error.h"
#include "quality/angles.h"
#include "quality/validity.h"

namespace nonobtuse {

namespace {

// By falling badness, then by index.
std::vector<Index> worst_first(std::vector<std::pair<double, Index>>& violations) {
  std::sort(violations.begin(), violations.end(), [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first > b.first : a.second < b.second;
  });
  std::vector<Index> triangles;
  triangles.reserve(violations.size());
  for (const auto& v : violations) triangles.push_back(v.second);
  return triangles;
}

}  // namespace

Certificate certify(const TriangleMesh& mesh, const CertificateBounds& bounds) {
  if (!(bounds.min_angle >= 0 && bounds.min_angle <= 60))
    throw InvalidInput("The minimum angle to certify must be from 0 to 60 degrees.");
  if (!(bounds.max_angle > 60 && bounds.max_angle <= 90))
    throw InvalidInput("The maximum angle to certify must be above 60 and at most 90 degrees.");
  quality::require_measurable(mesh);

  const quality::AngleBounds exact(bounds.min_angle, bounds.max_angle);
  std::vector<std::pair<double, Index>> too_large;
  std::vector<std::pair<double, Index>> too_small;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3& a = mesh.vertices[i];
    const Vec3& b = mesh.vertices[j];
    const Vec3& c = mesh.vertices[k];
    const bool large = !exact.below_max(a, b, c);
    const bool small = !exact.above_min(a, b, c);
    if (!large && !small) continue;
    // Cotangents order angles without a library's arc tangent.
    const auto cotangents = quality::shape_of(a, b, c).cotangents;
    const auto [least, most] = std::minmax_element(cotangents.begin(), cotangents.end());
    if (large) too_large.emplace_back(-*least, static_cast<Index>(t));
    if (small) too_small.emplace_back(*most, static_cast<Index>(t));
  }
  Certificate certificate;
  certificate.bounds = bounds;
  certificate.triangles = static_cast<Index>(mesh.triangles.size());
  certificate.certified = certificate.triangles > 0 && too_large.empty() && too_small.empty();
  certificate.too_large = worst_first(too_large);
  certificate.too_small = worst_first(too_small);
  return certificate;
}

}  // namespace nonobtuse
