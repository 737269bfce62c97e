#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

namespace haptrial::record {

/// Finds the chunks of our datasets in a file without its structure: each is a zlib stream with a
/// checksum, and its size when inflated tells its dataset.
///
/// @param longest  chunk when inflated [bytes]
/// Calls found(offset, raw) for each stream that is whole, in the order of the file; `raw` is
/// inflated, and valid until found() returns.
void scan_chunks(
    std::span<const std::uint8_t> file, std::size_t longest,
    const std::function<void(std::uint64_t offset, std::span<const std::uint8_t> raw)>& found);

}  // namespace haptrial::record
