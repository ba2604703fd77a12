#include <nonobtuse/sample.h>
#include <nonobtuse/version.h>

#include <cstdio>

int main() {
  const nonobtuse::TriangleMesh mesh = nonobtuse::sample_surface(16);
  std::printf("nonobtuse %s: %zu triangles\n", NONOBTUSE_VERSION, mesh.triangles.size());
  return mesh.triangles.empty() ? 1 : 0;
}
