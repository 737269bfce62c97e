#pragma once

#include <functional>
#include <string>
#include <vector>

#include "protocols/definition/definition.h"
#include "protocols/psychophysics/definition/beginning_words.h"

namespace haptrial::control {
struct HandleLoop;
struct HeldBy;
}  // namespace haptrial::control

namespace haptrial::protocols {

struct Presented;
struct TrialsDefinition;

/// Demands of the stages' fields on the handle and on the hand on it
/// (docs/algorithms/every-hand.md).
struct HandleText {
  std::vector<std::string> lines;  // what lighter hands get less of; what begins around the hand
  /// Says what the hand of [hand] does not carry, and what the certified device cannot present.
  std::vector<std::string> warnings;
};

/// Gathers these words over sets of values: of each stage it keeps the sum that asks for most.
/// @throws InputError for gains that no hand carries
class HandleReport {
 public:
  explicit HandleReport(const TrialsDefinition& definition);
  void add(const Presented& presented);
  HandleText words() const;

 private:
  /// The sum of what acts in a stage on one device, or a part of it.
  struct Load {
    std::string stage;
    std::size_t device{0};
    double stiffness{0.0};  // [N/m]
    double damping{0.0};    // [N·s/m]
    double driving{0.0};    // force along the hand's way over its velocity, at most [N·s/m]
    double mass{0.0};       // virtual [kg]
    double cutoff{0.0};     // of its acceleration [Hz]
    double lightest{0.0};   // hand that carries it [kg]
    bool own_hand{true};    // that of [hand] does
    bool ridged{false};     // ridges are part of it
    std::string surface;    // whose limit its ridges take most of
    double taken{0.0};      // by them [N]
    double left{0.0};       // by them, of that limit [N]
    std::string lower;      // how high they may be for the hand of [hand]; empty: as they are
  };
  /// A load with this share of its ridges' height.
  using LoadOf = std::function<Load(double)>;
  /// Keeps the largest demand of each stage and device.
  static void keep(const Load& load, double Load::*demand, std::vector<Load>& kept);
  Load load_of(const Presented& presented, std::size_t stage, std::size_t device,
               double height) const;
  void add(Load load, const LoadOf& of_height);
  control::HandleLoop loop_of(const Load& load) const;
  std::string where(const Load& load) const;
  std::string sum_of(const Load& load) const;
  std::string damping_text(const Load& load, double damping) const;
  bool by_fingers(const Load& load) const;
  double heaviest(const Load& load) const;
  void reject_slow_swings(const Load& load, const control::HandleLoop& loop) const;
  void judge(Load& load, const LoadOf& of_height) const;
  std::string lower_ridges(const Load& load, const LoadOf& of_height,
                           const control::HeldBy& hand) const;
  void note_driving(const Load& load);
  void note_late(const Load& load);
  void note_taken(const Load& load);
  double knock_of(const Load& load) const;
  void note_knocks(const Load& load);
  void note_stiffest(const Load& load);
  std::string amount_of(const Load& load) const;
  std::string left_on_bare_handle(const Load& load) const;
  void add_words_of_use(HandleText& words) const;

  const TrialsDefinition& d_;
  std::vector<DeviceArm> arms_;
  std::vector<Load> judged_;   // each sum once, whatever the stage
  std::vector<Load> worst_;    // (stages that some hand does not carry)
  std::vector<Load> taken_;    // (stages whose ridges take most of a surface's limit)
  std::vector<Load> late_;     // (stages whose force follows the hand too slowly)
  std::vector<Load> knocks_;   // (stages whose damping feels steps of the encoder)
  std::vector<Load> driving_;  // (stages that push a hand along its way)
  BeginningReport beginnings_;
  FeltParts felt_;
};

}  // namespace haptrial::protocols
