#include "refine/fidelity.h"

#include <algorithm>
#include <limits>

#include "numeric/random.h"

namespace nonobtuse::refine {
namespace {

using mesh::next;
using mesh::previous;

constexpr std::size_t kChunk = 512;
constexpr double kLeash = 1000;
constexpr int kLongestWalk = 64;  // steps; no more than a cap on degenerate input

// Walks from triangle `at` to the triangle locally nearest to y. Only where the closest point lies
// on the border of a triangle can a neighbour be nearer: then the one across, or all around the
// corner. `frame(t)` and `adjacent(t, k)` give the mesh, `accept(t)` may refuse triangles.
template <class Frame, class Adjacent, class CornerOf, class Accept>
Index walk(const Vec3& y, Index at, ClosestPoint& best, const Frame& frame,
           const Adjacent& adjacent, const CornerOf& corner_of, const Accept& accept) {
  best = frame(at).closest(y);
  for (int step = 0; step < kLongestWalk; ++step) {
    Index nearer = -1;
    const auto consider = [&](Index t) {
      const ClosestPoint c = frame(t).closest(y);
      if (c.squared_distance < best.squared_distance && accept(t)) best = c, nearer = t;
    };
    const std::array<double, 3> b = best.barycentric;
    for (int k = 0; k < 3; ++k) {
      if (b[next(k)] == 0 && b[previous(k)] == 0) {  // at corner k: look all around it
        const Index start = at;
        for (int side = 0; side < 2; ++side) {
          Index t = start;
          int corner = k;
          for (int turn = 0; turn < kLongestWalk; ++turn) {
            const Index across = adjacent(t, side == 0 ? next(corner) : previous(corner));
            if (across < 0 || across == start) break;
            corner = corner_of(t, corner, across);
            t = across;
            consider(t);
          }
          if (adjacent(t, side == 0 ? next(corner) : previous(corner)) == start) break;
        }
      } else if (b[k] == 0 && b[next(k)] > 0 && b[previous(k)] > 0) {
        const Index across = adjacent(at, k);
        if (across >= 0) consider(across);
      }
    }
    if (nearer < 0) break;
    at = nearer;
  }
  return at;
}

// Corner of `to` at the vertex that is corner k of `from`.
int same_corner(const std::vector<Triangle>& triangles, Index from, int k, Index to) {
  const Index v = triangles[from][k];
  return triangles[to][0] == v ? 0 : triangles[to][1] == v ? 1 : 2;
}

Vec3 facet_point(const mesh::Surface& surface, Index f, double s, double t) {
  const Triangle& v = surface.triangles[f];
  const Vec3 a = surface.vertices[v[0]];
  return a + s * (surface.vertices[v[1]] - a) + t * (surface.vertices[v[2]] - a);
}

TriangleFrame facet_frame(const mesh::Surface& surface, Index f) {
  const Triangle& v = surface.triangles[f];
  return {surface.vertices[v[0]], surface.vertices[v[1]], surface.vertices[v[2]]};
}

TriangleFrame triangle_frame(const mesh::EditableMesh& mesh, Index t) {
  const Triangle& v = mesh.triangle(t);
  return {mesh.positions[v[0]], mesh.positions[v[1]], mesh.positions[v[2]]};
}

}  // namespace

std::vector<Sample> sample_surface(const mesh::Surface& surface, Index count) {
  std::vector<Sample> samples;
  samples.reserve(count);
  const bool uniform = surface.size.empty();
  // Sites per area at a facet: the mean of 1/size^2.
  const auto share = [&](Index f) {
    if (uniform) return surface.areas[f];
    double sum = 0;
    for (const Index v : surface.triangles[f]) sum += 1 / (surface.size[v] * surface.size[v]);
    return surface.areas[f] * sum / 3;
  };
  double total = surface.area;
  if (!uniform) {
    total = 0;
    for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) total += share(f);
  }
  const double step = total / count;
  const auto weight = [&](Index f, double b1, double b2) {
    if (uniform) return step;
    const double size = surface.size_at(f, {1 - b1 - b2, b1, b2});
    return step * size * size * TargetSize::fidelity_factor(size * size);
  };
  double passed = 0;
  for (Index f = 0; f < static_cast<Index>(surface.triangles.size()); ++f) {
    passed += share(f);
    // Inside a facet a low-discrepancy sequence (Roberts 2018), shifted by the facet's stream.
    numeric::Random random(0x5a3b1e, f);
    double s = random.uniform(), t = random.uniform();
    while (static_cast<Index>(samples.size()) < count &&
           (static_cast<double>(samples.size()) + 0.5) * step <= passed) {
      s += 0.7548776662466927, t += 0.5698402909980532;
      if (s >= 1) s -= 1;
      if (t >= 1) t -= 1;
      const bool beyond = s + t > 1;
      const double b1 = beyond ? 1 - s : s, b2 = beyond ? 1 - t : t;
      samples.push_back({facet_point(surface, f, b1, b2), weight(f, b1, b2), f});
    }
  }
  return samples;
}

Vec3 vertex_area_vector(const mesh::EditableMesh& mesh, Index v) {
  Vec3 sum;
  for_ring(mesh, v, [&](Index t, int) { sum += area_vector(corners(mesh, t)); });
  return sum;
}

void Fidelity::attach_curves(const mesh::EditableMesh& mesh, const mesh::CurveNetwork* curves,
                             const parallel::Workers& workers) {
  valences.measure(mesh);
  if (!curves || mesh.knot.empty()) return;
  knots = Knots(*curves, mesh);
  patches.of_facet = std::make_shared<const std::vector<Index>>(surface_patches(surface()));
  patches.of_vertex = mesh_patches(mesh, surface(), surface_bvh(), *patches.of_facet, workers);
}

void Fidelity::search_samples(const mesh::EditableMesh& mesh, const parallel::Workers& workers) {
  std::vector<Triangle> triangles;
  std::vector<Index> old;
  for (Index t = 0; t < mesh.triangle_capacity(); ++t)
    if (mesh.alive_triangle(t)) triangles.push_back(mesh.triangle(t)), old.push_back(t);
  const spatial::TriangleBvh bvh(mesh.positions, triangles, workers);
  std::vector<Index> found(samples.size());
  workers.for_each(samples.size(), kChunk, [&](std::size_t s) {
    const Vec3 normal = surface().normals[samples[s].facet];
    const auto agrees = [&](Index t) {
      return dot(area_vector(corners(mesh, old[t])), normal) >= 0;
    };
    const auto same_patch = [&](Index t) {
      return patches.agree(samples[s].facet, mesh.triangle(old[t])[0]);
    };
    // Beyond two edge lengths, agreement is worth less than nearness.
    const double local = surface().size_at(samples[s].facet, {1.0 / 3, 1.0 / 3, 1.0 / 3});
    auto hit = bvh.closest_if(samples[s].point, 4.0 * local * local,
                              [&](Index t) { return same_patch(t) && agrees(t); });
    if (hit.triangle < 0)
      hit = bvh.closest_if(samples[s].point, std::numeric_limits<double>::infinity(), same_patch);
    if (hit.triangle < 0) hit = bvh.closest(samples[s].point);
    found[s] = old[hit.triangle];
  });
  sort_samples(found, mesh.triangle_capacity());
}

Index Fidelity::walk_to_nearest(const mesh::EditableMesh& mesh, Index from, const Sample& sample,
                                ClosestPoint& nearest) const {
  const Vec3 normal = surface().normals[sample.facet];
  return walk(
      sample.point, from, nearest, [&](Index t) { return triangle_frame(mesh, t); },
      [&](Index t, int k) { return mesh.adjacent(t, k); },
      [&](Index t, int k, Index to) { return same_corner(mesh.triangles(), t, k, to); },
      [&](Index t) { return dot(area_vector(corners(mesh, t)), normal) >= 0; });
}

void Fidelity::walk_samples(const mesh::EditableMesh& mesh, const parallel::Workers& workers) {
  std::vector<Index> found(samples.size());
  workers.for_each(first.size(), kChunk, [&](std::size_t t) {
    ClosestPoint nearest;
    for (Index s = first[t]; s >= 0; s = samples[s].next)
      found[s] = walk_to_nearest(mesh, static_cast<Index>(t), samples[s], nearest);
  });
  sort_samples(found, mesh.triangle_capacity());
}

std::vector<Index> Fidelity::rewalk(const mesh::EditableMesh& mesh,
                                    std::span<const Index> triangles) {
  std::vector<std::pair<Index, Index>> moves;  // sample, triangle
  for (Index t : triangles) {
    Index* link = &first[t];
    while (*link >= 0) {
      const Index s = *link;
      ClosestPoint nearest;
      const Index to = walk_to_nearest(mesh, t, samples[s], nearest);
      if (to == t) {
        link = &samples[s].next;
      } else {
        *link = samples[s].next;
        moves.emplace_back(s, to);
      }
    }
    update_triangle(mesh, t);
  }
  std::vector<Index> receivers;
  for (const auto& [s, to] : moves) {
    samples[s].next = first[to];
    first[to] = s;
    receivers.push_back(to);
  }
  return receivers;
}

void Fidelity::emphasize_far_points(const mesh::EditableMesh& mesh, double far, double growth) {
  const auto emphasize = [&](TangentPlane& plane, const Vec3& p) {
    if (squared_distance(p, plane.point) > far * far) plane.emphasis *= growth;
  };
  for (Index v = 0; v < mesh.vertex_capacity(); ++v)
    if (mesh.alive_vertex(v)) emphasize(vertex_planes[v], mesh.positions[v]);
  for (Index t = 0; t < mesh.triangle_capacity(); ++t) {
    if (!mesh.alive_triangle(t)) continue;
    const std::array<Vec3, 3> p = corners(mesh, t);
    for (int k = 0; k < 3; ++k) emphasize(edge_planes[t][k], midpoint(p, k));
  }
}

// Counting sort: the samples of a triangle lie together in memory, in a fixed order.
void Fidelity::sort_samples(const std::vector<Index>& triangle_of_sample, Index triangles) {
  std::vector<Index> start(triangles + 1, 0);
  for (Index t : triangle_of_sample) ++start[t + 1];
  for (Index t = 0; t < triangles; ++t) start[t + 1] += start[t];
  std::vector<Sample> sorted(samples.size());
  std::vector<Index> fill(start.begin(), start.end() - 1);
  for (std::size_t s = 0; s < samples.size(); ++s)
    sorted[fill[triangle_of_sample[s]]++] = samples[s];
  first.assign(triangles, -1);
  for (Index t = 0; t < triangles; ++t) {
    if (start[t] == start[t + 1]) continue;
    first[t] = start[t];
    for (Index s = start[t]; s < start[t + 1]; ++s)
      sorted[s].next = s + 1 < start[t + 1] ? s + 1 : -1;
  }
  samples = std::move(sorted);
}

void Fidelity::redistribute(const mesh::EditableMesh& mesh, std::span<const Index> triangles) {
  Index all = -1;
  for (Index t : triangles) {
    for (Index s = first[t]; s >= 0;) {
      const Index following = samples[s].next;
      samples[s].next = all;
      all = s;
      s = following;
    }
    first[t] = -1;
  }
  for (Index s = all; s >= 0;) {
    const Index following = samples[s].next;
    const Vec3 normal = surface().normals[samples[s].facet];
    Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Index t : triangles) {
      if (!mesh.alive_triangle(t)) continue;
      const std::array<Vec3, 3> p = corners(mesh, t);
      double d = TriangleFrame(p[0], p[1], p[2]).closest(samples[s].point).squared_distance;
      if (dot(area_vector(p), normal) < 0) d += 4 * size.area(mesh.triangle(t));
      if (best < 0 || d < least) least = d, best = t;
    }
    if (best < 0) {  // nothing is left of these triangles: the sample goes with them
      s = following;
      continue;
    }
    samples[s].next = first[best];
    first[best] = s;
    s = following;
  }
}

TangentPlane Fidelity::plane(const Vec3& p, const Vec3& foot, Index facet) const {
  TangentPlane result{1, 0, foot, surface().normals[facet], facet};
  // Where M is sharp the nearest point may lie on an edge or vertex with its facets turned far
  // away.
  const Vec3 offset = p - foot;
  const double d = length(offset);
  const double along = dot(offset, result.normal);
  if (d > 1e-6 && std::abs(along) < 0.9 * d) result.normal = (along < 0 ? -1 / d : 1 / d) * offset;
  return result;
}

TangentPlane Fidelity::search_foot(const Vec3& p, const Vec3& normal, double reach,
                                   Index vertex) const {
  const auto same_patch = [&](Index f) { return vertex < 0 || patches.agree(f, vertex); };
  const auto agrees = [&](Index f) {
    return dot(surface().normals[f], normal) >= 0 && same_patch(f);
  };
  auto hit = surface_bvh_->closest_if(p, reach * reach, agrees);
  if (hit.triangle < 0)
    hit = surface_bvh_->closest_if(p, std::numeric_limits<double>::infinity(), same_patch);
  if (hit.triangle < 0) hit = surface_bvh_->closest(p);
  return plane(p, hit.point, hit.triangle);
}

TangentPlane Fidelity::walk_foot(const Vec3& p, Index facet) const {
  const auto frame = [&](Index f) { return facet_frame(surface(), f); };
  const auto adjacent = [&](Index f, int k) { return surface().adjacent[f][k]; };
  const auto corner = [&](Index from, int k, Index to) {
    return same_corner(surface().triangles, from, k, to);
  };
  ClosestPoint nearest;
  const Index f = walk(p, facet, nearest, frame, adjacent, corner, [](Index) { return true; });
  return plane(p, facet_point(surface(), f, nearest.barycentric[1], nearest.barycentric[2]), f);
}

void Fidelity::update_vertex(const mesh::EditableMesh& mesh, Index v, bool search) {
  TangentPlane& plane = vertex_planes[v];
  double weight = 0;
  Vec3 normal;
  for_ring(mesh, v, [&](Index t, int) {
    const Vec3 a = area_vector(corners(mesh, t));
    normal += a;
    weight += length(a) / 24;
  });
  vertex_weights[v] = plane.emphasis * weight;
  if (!size.uniform()) vertex_weights[v] *= TargetSize::fidelity_factor(size.at(v) * size.at(v));
  plane.move_to(search || plane.facet < 0
                    ? search_foot(mesh.positions[v], normal, 2 * size.at(v), v)
                    : walk_foot(mesh.positions[v], plane.facet));
}

void Fidelity::update_triangle(const mesh::EditableMesh& mesh, Index t, bool search) {
  const std::array<Vec3, 3> p = corners(mesh, t);
  const Vec3 normal = area_vector(p);
  const double area = size.area(mesh.triangle(t));
  edge_weights[t] = 0.125 * length(normal);
  if (!size.uniform()) edge_weights[t] *= TargetSize::fidelity_factor(area);
  for (int k = 0; k < 3; ++k) {
    TangentPlane& plane = edge_planes[t][k];
    const Vec3 middle = midpoint(p, k);
    const bool known = plane.facet >= 0 && !search;
    if (known) plane.move_to(walk_foot(middle, plane.facet));
    if (!known || dot(surface().normals[plane.facet], normal) < 0)
      plane.move_to(search_foot(middle, normal, 2 * std::sqrt(area), mesh.triangle(t)[0]));
  }
}

void Fidelity::update_planes(const mesh::EditableMesh& mesh, const parallel::Workers& workers,
                             bool search) {
  vertex_planes.resize(mesh.vertex_capacity());
  vertex_weights.resize(mesh.vertex_capacity());
  edge_planes.resize(mesh.triangle_capacity());
  edge_weights.resize(mesh.triangle_capacity());
  workers.for_each(vertex_planes.size(), kChunk, [&](std::size_t v) {
    if (mesh.alive_vertex(static_cast<Index>(v)))
      update_vertex(mesh, static_cast<Index>(v), search);
  });
  workers.for_each(edge_planes.size(), kChunk, [&](std::size_t t) {
    if (mesh.alive_triangle(static_cast<Index>(t)))
      update_triangle(mesh, static_cast<Index>(t), search);
  });
}

double Fidelity::triangle(Index t, const std::array<Vec3, 3>& p,
                          std::array<Vec3, 3>* gradient) const {
  double energy = 0;
  for (int k = 0; k < 3; ++k) {
    const TangentPlane& plane = edge_planes[t][k];
    const double weight = weights.to_surface * edge_weights[t] * plane.emphasis;
    const double height = dot(midpoint(p, k) - plane.point, plane.normal) - plane.offset;
    energy += weight * height * height;
    if (gradient) {
      const Vec3 g = weight * height * plane.normal;
      (*gradient)[next(k)] += g;
      (*gradient)[previous(k)] += g;
    }
  }
  if (first[t] < 0) return energy;
  const TriangleFrame frame(p[0], p[1], p[2]);
  for (Index s = first[t]; s >= 0; s = samples[s].next) {
    const ClosestPoint c = frame.closest(samples[s].point);
    const double w = weights.to_mesh * samples[s].weight;
    energy += w * c.squared_distance;
    if (!gradient) continue;
    const auto& b = c.barycentric;
    const Vec3 g = 2 * w * (b[0] * p[0] + b[1] * p[1] + b[2] * p[2] - samples[s].point);
    for (int k = 0; k < 3; ++k) (*gradient)[k] += b[k] * g;
  }
  return energy;
}

double Fidelity::corner(Index t, const std::array<Vec3, 3>& p, int k, Vec3& gradient,
                        std::array<Vec3, 3>& hessian) const {
  double energy = 0;
  const auto add_projector = [&](double weight, const Vec3& n) {
    hessian[0] += weight * n.x * n;
    hessian[1] += weight * n.y * n;
    hessian[2] += weight * n.z * n;
  };
  for (int j = 0; j < 3; ++j) {
    const TangentPlane& plane = edge_planes[t][j];
    const double weight = weights.to_surface * edge_weights[t] * plane.emphasis;
    const double height = dot(midpoint(p, j) - plane.point, plane.normal) - plane.offset;
    energy += weight * height * height;
    if (j == k) continue;
    gradient += weight * height * plane.normal;
    add_projector(0.5 * weight, plane.normal);
  }
  if (first[t] < 0) return energy;
  const TriangleFrame frame(p[0], p[1], p[2]);
  const Vec3 normal = normalized(area_vector(p));
  double along_normal = 0;  // summed weights of samples that are pulled along the normal only
  double isotropic = 0;
  for (Index s = first[t]; s >= 0; s = samples[s].next) {
    const Vec3& y = samples[s].point;
    const ClosestPoint c = frame.closest(y);
    const double w = weights.to_mesh * samples[s].weight;
    energy += w * c.squared_distance;
    const auto& b = c.barycentric;
    if (b[k] == 0) continue;
    gradient += 2 * w * b[k] * (b[0] * p[0] + b[1] * p[1] + b[2] * p[2] - y);
    const double weight = 2 * w * b[k] * b[k];
    if (c.interior()) {
      along_normal += weight;
      continue;
    }
    // On an edge the point is free to slide along it, at the corner it is not.
    isotropic += weight;
    if (b[k] < 1) {
      const int other = b[next(k)] > 0 ? next(k) : previous(k);
      add_projector(-weight, normalized(p[other] - p[k]));
    }
  }
  add_projector(along_normal, normal);
  hessian[0].x += isotropic;
  hessian[1].y += isotropic;
  hessian[2].z += isotropic;
  return energy;
}

double Fidelity::vertex(Index v, const Vec3& p, Vec3* gradient) const {
  const TangentPlane& plane = vertex_planes[v];
  const double weight = weights.to_surface * vertex_weights[v];
  const double height = dot(p - plane.point, plane.normal) - plane.offset;
  if (gradient) *gradient += 2 * weight * height * plane.normal;
  double energy = weight * height * height;
  const double excess = std::abs(height) - leash * size.at(v);
  if (excess > 0) {
    const double stiffness = leash_stiffness(v);
    energy += stiffness * excess * excess;
    if (gradient) *gradient += (height < 0 ? -2 : 2) * stiffness * excess * plane.normal;
  }
  return energy;
}

Vec3 Fidelity::on_leash(Index v, const Vec3& from, const Vec3& to) const {
  const TangentPlane& plane = vertex_planes[v];
  const auto height = [&](const Vec3& p) {
    return dot(p - plane.point, plane.normal) - plane.offset;
  };
  const double most = std::max(2 * leash * size.at(v), std::abs(height(from)));
  const double h = height(to);
  if (!(std::abs(h) > most)) return to;
  return to - (h - std::clamp(h, -most, most)) * plane.normal;
}

double Fidelity::vertex_stiffness(Index v, const Vec3& p) const {
  const TangentPlane& plane = vertex_planes[v];
  const double height = dot(p - plane.point, plane.normal) - plane.offset;
  const bool taut = std::abs(height) > leash * size.at(v);
  return 2 * (weights.to_surface * vertex_weights[v] + (taut ? leash_stiffness(v) : 0));
}

// In the local size's units the same everywhere.
double Fidelity::leash_stiffness(Index v) const { return kLeash / (size.at(v) * size.at(v)); }

double Fidelity::mean_square(const mesh::EditableMesh& mesh) const {
  double sum = 0, total = 0;
  for (Index t = 0; t < static_cast<Index>(first.size()); ++t) {
    if (first[t] < 0) continue;
    const TriangleFrame frame = triangle_frame(mesh, t);
    for (Index s = first[t]; s >= 0; s = samples[s].next) {
      sum += samples[s].weight * frame.closest(samples[s].point).squared_distance;
      total += samples[s].weight;
    }
  }
  return total > 0 ? sum / total : 0;
}

}  // namespace nonobtuse::refine
