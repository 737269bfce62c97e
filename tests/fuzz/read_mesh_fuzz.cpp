// libFuzzer over the readers of meshes; the first byte says the format. Built on request:
//
//     cmake -B build-fuzz -DCMAKE_CXX_COMPILER=clang++ -DHAPTRIAL_FUZZ=ON -DHAPTRIAL_TESTS=OFF
//     cmake --build build-fuzz --target fuzz_read_mesh && build-fuzz/fuzz_read_mesh

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/geometry/files/mesh_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace haptrial::geometry;  // NOLINT: the fuzzer's one function
  if (size == 0) {
    return 0;
  }
  const auto format = static_cast<MeshFormat>(data[0] % 3);
  const std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    const Mesh mesh = parse_mesh(bytes, format, "m");
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::int32_t corner : triangle) {
        if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.vertices.size()) {
          std::abort();
        }
      }
    }
  } catch (const haptrial::InputError&) {
  }
  return 0;
}
