// Remeshes a surface, with progress and a way to stop, and carries a value per vertex over.
//
//   transfer [IN OUT [VERTICES]]    without arguments: a sample, 800 vertices, nothing written
#include <nonobtuse/io.h>
#include <nonobtuse/remesh.h>
#include <nonobtuse/sample.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <vector>

using nonobtuse::Index;
using nonobtuse::RemeshResult;
using nonobtuse::TriangleMesh;
using nonobtuse::Vec3;

// Values at the input's vertices, interpolated at the nearest point to each vertex of the result.
std::vector<double> transfer(const TriangleMesh& input, const std::vector<double>& values,
                             const RemeshResult& result) {
  std::vector<double> carried(result.mesh.vertices.size());
  for (std::size_t v = 0; v < carried.size(); ++v) {
    const auto& corner = input.triangles[result.source_triangle[v]];
    const Vec3& weight = result.barycentric[v];
    carried[v] =
        weight.x * values[corner[0]] + weight.y * values[corner[1]] + weight.z * values[corner[2]];
  }
  return carried;
}

int run(int argc, char** argv) {
  const TriangleMesh input = argc > 1 ? nonobtuse::clean(nonobtuse::read_mesh(argv[1]).mesh).mesh
                                      : nonobtuse::sample_surface(24);
  nonobtuse::RemeshOptions options;
  options.vertices = argc > 3 ? std::atoi(argv[3]) : argc > 2 ? 0 : 800;

  nonobtuse::Context context;
  int heard = 0;
  context.progress = [&](const nonobtuse::Progress& progress) {
    if (++heard % 20 == 0)
      std::cerr << progress.stage << ' ' << std::lround(100 * progress.fraction) << " %\n";
    return true;  // false would stop the call, which then gives the best mesh so far
  };
  const RemeshResult result = nonobtuse::remesh(input, options, context);

  // Heights: the transferred ones are those of the result, but for the distance of the surfaces.
  std::vector<double> height;
  for (const Vec3& p : input.vertices) height.push_back(p.z);
  const std::vector<double> carried = transfer(input, height, result);
  double difference = 0;
  for (std::size_t v = 0; v < carried.size(); ++v)
    difference = std::max(difference, std::abs(carried[v] - result.mesh.vertices[v].z));

  std::cout << result.mesh.vertices.size() << " vertices, angles from " << result.angles.min_angle
            << " to " << result.angles.max_angle << " degrees, "
            << (result.certificate.certified ? "certified" : "not certified")
            << "\nlargest difference of transferred heights " << difference << "\n";
  if (argc > 2) nonobtuse::write_mesh(argv[2], result.mesh);
  return result.certificate.certified ? 0 : 1;
}

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 3;
  }
}
