#include "core/record/hdf5/deflate.h"

#include <libdeflate.h>

#include <new>

namespace haptrial::record {

struct Deflater::Impl {
  explicit Impl(int level) : compressor(libdeflate_alloc_compressor(level)) {
    if (compressor == nullptr) {
      throw std::bad_alloc();
    }
  }
  ~Impl() { libdeflate_free_compressor(compressor); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  libdeflate_compressor* compressor;
  std::vector<std::uint8_t> out;
  std::size_t size{0};
};

Deflater::Deflater(int level) : impl_(std::make_unique<Impl>(level)) {}
Deflater::~Deflater() = default;
Deflater::Deflater(Deflater&&) noexcept = default;
Deflater& Deflater::operator=(Deflater&&) noexcept = default;

std::span<const std::uint8_t> Deflater::compress(std::span<const std::uint8_t> bytes) {
  const std::size_t bound = libdeflate_zlib_compress_bound(impl_->compressor, bytes.size());
  impl_->out.resize(bound + 1);
  impl_->size = libdeflate_zlib_compress(impl_->compressor, bytes.data(), bytes.size(),
                                         impl_->out.data(), bound);
  impl_->out[impl_->size] = 0;
  return {impl_->out.data(), impl_->size};
}

std::span<const std::uint8_t> Deflater::padded() const {
  return {impl_->out.data(), impl_->size + 1};
}

struct Inflater::Impl {
  Impl() : decompressor(libdeflate_alloc_decompressor()) {
    if (decompressor == nullptr) {
      throw std::bad_alloc();
    }
  }
  ~Impl() { libdeflate_free_decompressor(decompressor); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  libdeflate_decompressor* decompressor;
};

Inflater::Inflater() : impl_(std::make_unique<Impl>()) {}
Inflater::~Inflater() = default;
Inflater::Inflater(Inflater&&) noexcept = default;
Inflater& Inflater::operator=(Inflater&&) noexcept = default;

bool Inflater::decompress(std::span<const std::uint8_t> compressed, std::span<std::uint8_t> out) {
  return libdeflate_zlib_decompress(impl_->decompressor, compressed.data(), compressed.size(),
                                    out.data(), out.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

Inflater::Lengths Inflater::decompress_prefix(std::span<const std::uint8_t> bytes,
                                              std::span<std::uint8_t> out) {
  Lengths lengths;
  const libdeflate_result result =
      libdeflate_zlib_decompress_ex(impl_->decompressor, bytes.data(), bytes.size(), out.data(),
                                    out.size(), &lengths.compressed, &lengths.raw);
  return result == LIBDEFLATE_SUCCESS ? lengths : Lengths{};
}

}  // namespace haptrial::record
