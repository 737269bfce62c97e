#include "core/record/recovery/chunk_scan.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/record/hdf5/deflate.h"

namespace haptrial::record {
namespace {

constexpr std::uint8_t kFirstByte = 0x78;  // deflate with a window of 32 KiB

/// Whether the two bytes can begin a zlib stream without a dictionary (RFC 1950, 2.2).
bool is_header(const std::uint8_t* at) {
  return (at[0] * 256 + at[1]) % 31 == 0 && (at[1] & 0x20) == 0;
}

}  // namespace

void scan_chunks(
    std::span<const std::uint8_t> file, std::size_t longest,
    const std::function<void(std::uint64_t offset, std::span<const std::uint8_t> raw)>& found) {
  std::vector<std::uint8_t> raw(longest);
  Inflater inflater;
  std::size_t at = 0;
  while (at + 2 <= file.size()) {
    const void* next = std::memchr(file.data() + at, kFirstByte, file.size() - at - 1);
    if (next == nullptr) {
      return;
    }
    at = static_cast<std::size_t>(static_cast<const std::uint8_t*>(next) - file.data());
    Inflater::Lengths lengths;
    if (is_header(file.data() + at)) {
      lengths = inflater.decompress_prefix(file.subspan(at), raw);
    }
    if (lengths.raw > 0) {
      found(at, {raw.data(), lengths.raw});
    }
    at += std::max<std::size_t>(lengths.compressed, 1);
  }
}

}  // namespace haptrial::record
