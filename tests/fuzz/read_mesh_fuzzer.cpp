// libFuzzer target for the readers, the cleaning and the writers: no bytes may crash them, and what
// was read is written and read back the same. Built only with clang and NONOBTUSE_FUZZ.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "nonobtuse/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace nonobtuse;
  static const char* const names[] = {"a", "a.obj", "a.off", "a.ply", "a.stl"};
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const ReadResult read = read_mesh_from_memory(bytes, names[data[0] % 5]);
    const std::string written = write_mesh_to_memory(FileFormat::Off, read.mesh);
    if (read_mesh_from_memory(written, "a.off").mesh.triangles != read.mesh.triangles) std::abort();
    const TriangleMesh cleaned = clean(read.mesh).mesh;
    if (!clean(cleaned).repairs.empty()) std::abort();
  } catch (const IoError&) {
  } catch (const InvalidInput&) {
  }
  return 0;
}
