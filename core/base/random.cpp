#include "core/base/random.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include <bit>
#include <limits>

#include "core/base/fnv.h"

namespace haptrial {
namespace {

std::uint64_t split_mix(std::uint64_t& x) noexcept {
  std::uint64_t z = (x += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

std::uint64_t next(std::array<std::uint64_t, 4>& s) noexcept {
  const std::uint64_t result = std::rotl(s[0] + s[3], 23) + s[0];
  const std::uint64_t t = s[1] << 17;
  s[2] ^= s[0];
  s[3] ^= s[1];
  s[1] ^= s[2];
  s[0] ^= s[3];
  s[2] ^= t;
  s[3] = std::rotl(s[3], 45);
  return result;
}

// GSL sees the stream as a 32-bit generator whose state is ours.
using State = std::array<std::uint64_t, 4>;
unsigned long gsl_get(void* state) { return next(*static_cast<State*>(state)) >> 32; }
double gsl_get_double(void* state) {
  return static_cast<double>(next(*static_cast<State*>(state)) >> 11) * 0x1p-53;
}
void gsl_set(void*, unsigned long) {}
const gsl_rng_type kGslType{"haptrial", 0xffffffffu,   0, sizeof(State), gsl_set,
                            gsl_get,    gsl_get_double};

}  // namespace

std::uint64_t derived_seed(std::uint64_t seed, std::string_view name) {
  std::uint64_t x = seed;
  std::uint64_t y = split_mix(x) ^ fnv1a(name);
  return split_mix(y);
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
  std::uint64_t x = derived_seed(seed, name);
  for (auto& word : state_) {
    word = split_mix(x);
  }
}

std::uint64_t RandomStream::bits() noexcept { return next(state_); }

double RandomStream::uniform() noexcept { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double RandomStream::uniform(double low, double high) noexcept {
  const double value = low + (high - low) * uniform();
  return value < high ? value : low;  // rounding can reach high
}

double RandomStream::normal() noexcept {
  const gsl_rng generator{&kGslType, &state_};
  return gsl_ran_gaussian_ziggurat(&generator, 1.0);
}

std::uint64_t RandomStream::below(std::uint64_t bound) noexcept {
  const std::uint64_t limit =
      std::numeric_limits<std::uint64_t>::max() - std::numeric_limits<std::uint64_t>::max() % bound;
  std::uint64_t value = bits();
  while (value >= limit) {
    value = bits();
  }
  return value % bound;
}

}  // namespace haptrial
