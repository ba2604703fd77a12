#include "mesh/curve_network.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "numeric/vec3.h"

namespace nonobtuse::mesh {

namespace {

// Segments run from point i to point i + 1 (closed: the last one back to the first).
Index segment_count(const Curve& curve) {
  const Index points = static_cast<Index>(curve.points.size());
  return curve.closed ? points : points - 1;
}

double segment_end(const Curve& curve, Index i) {
  return i + 1 < static_cast<Index>(curve.arc.size()) ? curve.arc[i + 1] : curve.length;
}

Vec3 direction(const Curve& curve, Index i) {
  const Index after = i + 1 < static_cast<Index>(curve.points.size()) ? i + 1 : 0;
  return normalized(curve.points[after] - curve.points[i]);
}

// The segment that holds a canonical arc.
Index segment_at(const Curve& curve, double arc) {
  const auto after = std::upper_bound(curve.arc.begin(), curve.arc.end(), arc);
  const Index i = static_cast<Index>(after - curve.arc.begin()) - 1;
  return std::clamp(i, Index{0}, segment_count(curve) - 1);
}

struct Nearest {
  double arc = 0;
  double squared_distance = std::numeric_limits<double>::infinity();
};

// The point of segment i nearest to p, with arcs in [low, high] only; `offset` is added to the
// segment's own arcs (turns around a closed curve).
void consider(const Curve& curve, Index i, double offset, double low, double high, const Vec3& p,
              Nearest& best) {
  const double begin = curve.arc[i] + offset;
  const double from = std::max(low, begin);
  const double to = std::min(high, segment_end(curve, i) + offset);
  if (from > to) return;
  const Vec3 along = direction(curve, i);
  const double arc = std::clamp(begin + dot(p - curve.points[i], along), from, to);
  const double d = squared_distance(p, curve.points[i] + (arc - begin) * along);
  if (d < best.squared_distance) best = {arc, d};
}

}  // namespace

Curve make_curve(std::vector<Vec3> points, bool closed) {
  Curve curve;
  curve.points = std::move(points);
  curve.closed = closed;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    if (i > 0) curve.length += distance(curve.points[i - 1], curve.points[i]);
    curve.arc.push_back(curve.length);
  }
  if (closed) curve.length += distance(curve.points.back(), curve.points.front());
  return curve;
}

double canonical_arc(const Curve& curve, double arc) {
  if (!curve.closed) return std::clamp(arc, 0.0, curve.length);
  if (arc >= 0 && arc < curve.length) return arc;
  const double turned = arc - curve.length * std::floor(arc / curve.length);
  return turned < curve.length ? turned : 0;  // rounding may end at the length itself
}

Vec3 point_at(const Curve& curve, double arc) {
  const double s = canonical_arc(curve, arc);
  if (!curve.closed && s == curve.length) return curve.points.back();
  const Index i = segment_at(curve, s);
  return curve.points[i] + (s - curve.arc[i]) * direction(curve, i);
}

Vec3 tangent_at(const Curve& curve, double arc) {
  return direction(curve, segment_at(curve, canonical_arc(curve, arc)));
}

double project(const Curve& curve, const Vec3& p, double arc, double reach) {
  Nearest best{arc, std::numeric_limits<double>::infinity()};
  const Index count = segment_count(curve);
  if (!curve.closed) {
    const double low = std::max(0.0, arc - reach), high = std::min(curve.length, arc + reach);
    for (Index i = segment_at(curve, low); i < count && curve.arc[i] <= high; ++i)
      consider(curve, i, 0, low, high, p, best);
    return best.arc;
  }
  const double within = std::min(reach, 0.5 * curve.length);
  const double low = arc - within, high = arc + within;
  const double first = canonical_arc(curve, low);
  Index i = segment_at(curve, first);
  double offset = low - first;
  for (Index visited = 0; visited <= count && curve.arc[i] + offset <= high; ++visited) {
    consider(curve, i, offset, low, high, p, best);
    if (++i == count) i = 0, offset += curve.length;
  }
  return best.arc;
}

double project(const Curve& curve, const Vec3& p) {
  Nearest best;
  for (Index i = 0; i < segment_count(curve); ++i) consider(curve, i, 0, 0, curve.length, p, best);
  return canonical_arc(curve, best.arc);
}

}  // namespace nonobtuse::mesh
