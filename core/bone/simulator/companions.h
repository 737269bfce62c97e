#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <thread>
#include <vector>

#include "core/bone/dust/dust.h"
#include "core/bone/dust/dust_worker.h"
#include "core/bone/simulator/simulator.h"

namespace haptrial::bone {

/// Threads that run beside the servo thread: the search for separate parts, and dust.
class Companions {
 public:
  virtual ~Companions() = default;
  /// Servo thread, after each tick of the simulator.
  virtual void after_tick(const Simulator& simulator, double dt) noexcept = 0;
  /// Balance of the dust. Not the servo thread.
  virtual DustBalance dust() const = 0;
  /// Gives the quads if they changed since `version`, which is brought up to date. One other
  /// thread.
  virtual bool quads(std::vector<DustQuad>& quads, std::uint64_t& version) const = 0;
  /// Balance and quads of the blood, as those of the dust.
  virtual DustBalance blood() const = 0;
  virtual bool blood_quads(std::vector<DustQuad>& quads, std::uint64_t& version) const = 0;
  /// Waits, while nothing ticks, until the dust has taken up all that was left for it. The thread
  /// that ends passes.
  virtual void settle() = 0;
};

/// Blood is dust that does not pile.
DustParameters blood_parameters();

struct CompanionParameters {
  /// Whether dust falls and piles; else it is only counted, as lying, which takes no time.
  bool dusty{true};
  DustParameters dust;
  bool bleeds{false};  // whether there may be blood
  DustParameters blood = blood_parameters();
  double dust_period{0.02};    // > 0 [s]
  double search_period{0.05};  // > 0 [s]
};

/// All of it on the thread that ticks, every so many ticks: a function of what was drilled alone.
/// For the simulated clock; allocates.
class SteppedCompanions final : public Companions {
 public:
  /// @param simulator  outlives this, as for the next class
  /// @param rate       of ticks [Hz]
  /// @param search     false in a replay, which is told what was separated
  SteppedCompanions(Simulator& simulator, const CompanionParameters& parameters, double rate,
                    bool search = true);

  void after_tick(const Simulator& simulator, double dt) noexcept override;
  DustBalance dust() const override;
  bool quads(std::vector<DustQuad>& quads, std::uint64_t& version) const override;
  DustBalance blood() const override;
  bool blood_quads(std::vector<DustQuad>& quads, std::uint64_t& version) const override;
  void settle() override;

 private:
  void step_flows(double dt);

  Simulator& simulator_;
  std::optional<Dust> dust_;
  std::optional<Dust> blood_;
  double counted_{0.0};         // of dust that is only counted [voxels]
  std::uint64_t dust_every_;    // [ticks]
  std::uint64_t search_every_;  // [ticks]; 0: never
  std::uint64_t ticks_{0};
  double unstepped_{0.0};  // [s]
  std::vector<DustBone> bones_;
};

/// Each on a thread of its own, beside a session on the real clock. The servo thread only leaves
/// messages.
class ThreadedCompanions final : public Companions {
 public:
  /// @param search  false where the simulator is told what was separated
  ThreadedCompanions(Simulator& simulator, const CompanionParameters& parameters,
                     bool search = true);

  void after_tick(const Simulator& simulator, double dt) noexcept override;
  DustBalance dust() const override;
  bool quads(std::vector<DustQuad>& quads, std::uint64_t& version) const override {
    return dust_ && dust_->quads(quads, version);
  }
  DustBalance blood() const override;
  bool blood_quads(std::vector<DustQuad>& quads, std::uint64_t& version) const override {
    return blood_ && blood_->quads(quads, version);
  }
  void settle() override;

 private:
  void search(const std::stop_token& stop);

  Simulator& simulator_;
  double search_period_;
  std::optional<DustWorker> dust_;
  std::optional<DustWorker> blood_;
  std::atomic<double> counted_{0.0};  // of dust that is only counted [voxels]
  std::jthread searcher_;             // last: it ends before what it uses
};

}  // namespace haptrial::bone
