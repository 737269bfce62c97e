#include "core/record/deflate.h"

#include <libdeflate.h>

#include <new>

namespace haptrial::record {

struct Deflater::Impl {
  explicit Impl(int level) : compressor(libdeflate_alloc_compressor(level)) {
    if (compressor == nullptr) throw std::bad_alloc();
  }
  ~Impl() { libdeflate_free_compressor(compressor); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  libdeflate_compressor* compressor;
  std::vector<std::uint8_t> out;
};

Deflater::Deflater(int level) : impl_(std::make_unique<Impl>(level)) {}
Deflater::~Deflater() = default;
Deflater::Deflater(Deflater&&) noexcept = default;
Deflater& Deflater::operator=(Deflater&&) noexcept = default;

std::span<const std::uint8_t> Deflater::compress(std::span<const std::uint8_t> bytes) {
  impl_->out.resize(libdeflate_zlib_compress_bound(impl_->compressor, bytes.size()));
  const std::size_t size = libdeflate_zlib_compress(impl_->compressor, bytes.data(), bytes.size(),
                                                    impl_->out.data(), impl_->out.size());
  return {impl_->out.data(), size};
}

struct Inflater::Impl {
  Impl() : decompressor(libdeflate_alloc_decompressor()) {
    if (decompressor == nullptr) throw std::bad_alloc();
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

}  // namespace haptrial::record
