#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/base/random.h"

namespace haptrial::nerve {

inline constexpr std::size_t kMostSamples = 32;  // a tick

struct EmgParameters {
  double rate{8000.0};      // samples a second, a whole number of them a tick [Hz]
  double background{4e-6};  // root mean square without any event [V]
  double unit{150e-6};      // peak of a discharge of middle strength [V]
  double drilling{20e-6};   // artefact while the burr turns, root mean square [V]
  double suction{8e-6};     // likewise
  double spike{400e-6};     // artefact where either is switched on or off, peak [V]
  double stimulus{2e-3};    // artefact of a stimulus pulse, peak [V]
};

/// A discharge that was put into a signal: the truth that a detector is held against.
struct SimulatedDischarge {
  enum class Kind : std::uint8_t { kBurst, kTrain, kResponse, kArtefact } kind{Kind::kBurst};
  std::uint64_t first{0};  // sample, from 0
  std::uint64_t last{0};
  double amplitude{0.0};  // peak [V]
};

/// The electromyogram of one muscle, made sample by sample: noise, discharges of motor units (each
/// a biphasic wave of about 4 ms) alone, in bursts (5 to 30 within 50 to 300 ms, unevenly), in
/// trains (60 to 200 a second, evenly and of one shape, up to seconds: the "A trains" that go with
/// palsy, Romstöck et al. 2000), and together as the answer to a stimulus; artefacts of drill,
/// suction and stimulus. Servo thread: no allocation, lock, I/O or throw.
class Emg {
 public:
  Emg(const EmgParameters& parameters, std::uint64_t seed, std::string_view name);

  /// @param severity  0 to 1: stronger and longer. @returns what comes, from the next sample on
  SimulatedDischarge burst(double severity) noexcept;
  SimulatedDischarge train(double severity) noexcept;
  /// Plants the response to a stimulus. @param latency  [s] @param amplitude  peak [V]
  SimulatedDischarge response(double latency, double amplitude) noexcept;

  /// Artefacts of this tick; those of a drill and a suction are the same in every muscle.
  struct Artefacts {
    std::span<const float> common;  // as long as the tick, of root mean square 1
    bool drilling{false};
    bool suction{false};
    bool stimulus{false};  // a pulse begins with the tick
    float spike{0.0f};     // where something is switched: peak, as it reaches this muscle [V]
  };
  /// The samples of a tick [V]. @param count  of them, at most kMostSamples
  std::span<const float> step(const Artefacts& artefacts, std::size_t count) noexcept;
  std::uint64_t samples() const noexcept { return at_; }  // made so far

 private:
  static constexpr std::size_t kAhead = 4096;  // half a second at 8 kHz
  struct Train {
    std::uint64_t next{0};  // sample of its next discharge
    std::uint64_t end{0};
    double interval{0.0};  // [samples]
    double amplitude{0.0};
  };
  void discharge(std::uint64_t sample, double amplitude) noexcept;

  EmgParameters p_;
  RandomStream random_;
  RandomStream noise_;
  std::array<float, 64> wave_{};
  std::size_t wave_length_{0};
  std::array<float, kAhead> ahead_{};  // what is still to come, at sample % kAhead
  std::array<float, kMostSamples> out_{};
  std::array<Train, 8> trains_{};
  std::uint64_t at_{0};
  double smooth_{0.0};  // of the noise
};

/// Noise that every muscle's electrodes pick up from the same source: white, of root mean square 1.
class CommonNoise {
 public:
  CommonNoise(std::uint64_t seed, std::string_view name) : random_(seed, name) {}
  std::span<const float> step(std::size_t count) noexcept;

 private:
  RandomStream random_;
  std::array<float, kMostSamples> out_{};
};

/// The answer of a nerve to a current: threshold at contact, and how it rises with distance.
struct StimulationParameters {
  double threshold{0.1e-3};   // at the nerve [A]
  double per_distance{0.25};  // more for each metre of bone between [A/m]
  double spread{0.15};        // of the recruitment, as a share of the threshold
  double latency{0.0062};     // [s]
  double most{500e-6};        // peak of the whole muscle's answer [V]
};
/// Peak of the answer [V]: 0 well below the threshold, `most` well above. @param current  [A]
double answer_to(double current, double distance, const StimulationParameters& p) noexcept;

}  // namespace haptrial::nerve
