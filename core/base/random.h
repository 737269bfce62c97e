#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace haptrial {

/// A named stream of random numbers: the same seed and name give the same numbers on every machine
/// and in every thread; other names give independent streams.
///
/// Generator: xoshiro256++ (Blackman and Vigna 2021), its state filled by SplitMix64 from a
/// 64-bit FNV-1a hash of the name mixed with the seed. Distributions: GSL.
/// Servo thread: drawing does not allocate, lock or throw.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  std::uint64_t bits() noexcept;                      // uniform over 64 bits
  double uniform() noexcept;                          // [0, 1)
  double uniform(double low, double high) noexcept;   // [low, high)
  double normal() noexcept;                           // mean 0, standard deviation 1
  std::uint64_t below(std::uint64_t bound) noexcept;  // 0 .. bound - 1 without bias; bound > 0

 private:
  std::array<std::uint64_t, 4> state_;
};

/// The seed of a part (a participant, a block) of something that has a seed itself.
std::uint64_t derived_seed(std::uint64_t seed, std::string_view name);

}  // namespace haptrial
