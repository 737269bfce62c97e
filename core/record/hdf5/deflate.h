#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace haptrial::record {

/// The deflate filter of HDF5 (zlib format), run outside of the library and its lock.
/// One thread at a time for each object.
class Deflater {
 public:
  explicit Deflater(int level);
  ~Deflater();
  Deflater(Deflater&&) noexcept;
  Deflater& operator=(Deflater&&) noexcept;

  /// The result is valid until the next call.
  std::span<const std::uint8_t> compress(std::span<const std::uint8_t> bytes);
  /// The last result with a byte behind it that inflating ignores.
  std::span<const std::uint8_t> padded() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

class Inflater {
 public:
  Inflater();
  ~Inflater();
  Inflater(Inflater&&) noexcept;
  Inflater& operator=(Inflater&&) noexcept;

  /// @returns false when the input is damaged or does not fill `out` exactly.
  bool decompress(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out);

  /// A stream of unknown length at the start of `bytes`.
  struct Lengths {
    std::size_t compressed{0};  // [bytes]; 0 when there is no whole stream that fits `out`
    std::size_t raw{0};
  };
  Lengths decompress_prefix(std::span<const std::uint8_t> bytes, std::span<std::uint8_t> out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace haptrial::record
