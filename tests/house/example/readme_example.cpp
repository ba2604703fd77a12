// The C++ example of README.md, word for word between the marks; a test compares the two.
// README begins
#include <nonobtuse/io.h>
#include <nonobtuse/remesh.h>

#include <iostream>

int remesh_file(const std::string& in, const std::string& out) {
  const nonobtuse::TriangleMesh mesh = nonobtuse::clean(nonobtuse::read_mesh(in).mesh).mesh;

  nonobtuse::RemeshOptions options;
  options.vertices = 8000;
  const nonobtuse::RemeshResult result = nonobtuse::remesh(mesh, options);

  nonobtuse::write_mesh(out, result.mesh);
  std::cout << result.angles.min_angle << " .. " << result.angles.max_angle << " degrees\n";
  return result.status == nonobtuse::Status::Converged ? 0 : 1;
}
// README ends
