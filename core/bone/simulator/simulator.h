#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/tool_state.h"
#include "core/bone/drill/drill.h"
#include "core/bone/drill/heat.h"
#include "core/bone/dust/dust.h"
#include "core/bone/model/world.h"
#include "core/bone/simulator/bleeding.h"
#include "core/bone/simulator/cut_plane.h"
#include "core/bone/simulator/handpiece.h"
#include "core/bone/simulator/held_bone.h"
#include "core/bone/simulator/injury_watch.h"
#include "core/bone/simulator/microscope.h"
#include "core/bone/simulator/screws.h"
#include "core/bone/simulator/second_hand.h"
#include "core/bone/simulator/simulator_tools.h"
#include "core/bone/simulator/soft_tissue.h"
#include "core/bone/simulator/tuning.h"

namespace haptrial::bone {

/// Function of a button, pedal or key; a tick is given a bit for each that is held.
enum class Function : std::uint8_t {
  kPower,         // the burr turns, the suction sucks
  kNextTool,      // these act when they go down
  kPreviousTool,  //
  kCameraMove,    // while held the hand moves the view
  kCameraTurn,    // while held it turns it
  kZoomIn,        // while held
  kZoomOut,       //
  kCarry,         // while held the touched piece of bone goes with the hand
  kApply,         // when it goes down: cut, fix the plate
  kDetach,        // when it goes down: the plate that was fixed last comes off
  kFinish,        // the participant is done
  kStill,         // when it goes down: the screen shows the next still; nothing of the bone follows
  kReverse,       // when it goes down: burrs turn the other way
};
inline constexpr std::size_t kFunctions = 13;
/// Name of a function in definitions: "power", "next_tool", ...
std::string_view name_of(Function function) noexcept;
constexpr std::uint32_t bit(Function function) noexcept {
  return std::uint32_t{1} << static_cast<unsigned>(function);
}

struct SimulatorParameters {
  std::vector<ToolSpec> tools;  // at least one; the first is in hand at the start
  WorldParameters world;
  Eigen::Isometry3d pose_WB{Eigen::Isometry3d::Identity()};  // of the bone
  MicroscopeParameters camera;
  std::vector<SoftTissueParameters> soft_tissue{};  // the bone's structures that are soft
  std::optional<TubeParameters> tube{};             // in the other hand; none: there is one hand
  std::optional<HeatParameters> heat{};             // none: nothing warms up
  BleedingParameters bleeding{};                    // of the bone's structures
};

/// The constants of a simulator that may change while it ticks.
Tuning tuning_of(const SimulatorParameters& parameters) noexcept;

/// Input of one tick, all in W.
struct SimulatorInput {
  ToolState tool;
  std::uint32_t functions{0};  // bit(Function) of those held
  double power{0.0};           // with which the burr turns or the suction sucks, 0 to 1
  double dt{1e-3};             // since the last tick [s]
  TubeInput tube{};            // in the other hand, if there is one
};

enum class HandMode : std::uint8_t { kTool, kCameraMove, kCameraTurn, kCarry };

/// Output of one tick.
struct SimulatorOutput {
  Eigen::Vector3d force{Eigen::Vector3d::Zero()};  // of the bone on the tool [N]
  Eigen::Vector3d drag{Eigen::Vector3d::Zero()};   // the part of it that the turning teeth give [N]
  Eigen::Vector3d shaft{
      Eigen::Vector3d::Zero()};  // of bone on the burr's shaft, beside `force` [N]
  Eigen::Vector3d pushed{
      Eigen::Vector3d::Zero()};  // of the other hand's tube on the tool, beside `force`, and of the
                                 // tool on the tube with the other sign [N]
  int tool{0};                   // in hand
  HandMode mode{HandMode::kTool};
  double power{0.0};    // of the tool in hand, 0 where it has none
  bool contact{false};  // the tool, or the bone that it carries, touches bone
  int immersed{0};      // samples of the tool, or of the bone that it carries, in bone
  double removed{0.0};  // sum of densities that the burr took [voxels]
  double cut{0.0};      // that the cut plane took [voxels]
  bool yields{false};   // soft tissue gives way to the tool
  bool camera_changed{false};
  bool finished{false};  // kFinish went down
  PieceSet moved{0};     // pieces that a hand carried, or let go of, on this tick
  bool let_go{false};    // of them
  int detached{-1};      // plate that came off on this tick, with its screws; -1: none
  TubeOutput tube{};
};

/// A part that was separated, as it is recorded: what BoneWorld::split_at or crumble_at repeats.
struct RecordedSplit {
  int from{0};
  int to{-1};                // the new piece; -1: turned to dust
  std::vector<Voxel> seeds;  // of a piece; one of a crumb
};

/// The bone simulator as far as it belongs to the servo thread: bone, tools, view. One tick is a
/// function of what came before and of its input alone; what runs beside it (core/bone/
/// companions.h) hands over separated parts, whose takeover separations() tells.
///
/// A tool that is in bone when it is taken in hand, or when the hand comes back from the camera, is
/// neither felt nor drills before it has been free: it would be thrown out.
///
/// Servo thread: no allocation, lock, wait or throw after construction
/// (DrillingPassTest.ATickDoesNotAllocateBesideThreads).
class Simulator {
 public:
  /// @throws std::invalid_argument as the parts do, or without tools.
  Simulator(const BoneModel& model, const SimulatorParameters& parameters);
  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;

  /// Call before the first tick of a pass: buttons that are held down are not taken as going down.
  void begin(std::uint32_t functions_held) noexcept;
  /// Other constants from the next tick on: rates of removal at once, forces by a transition.
  /// @param tuning  valid for these tools (check(FeelParameters))
  void tune(const Tuning& tuning) noexcept;
  /// The force is on its way between two tunings; the next one is to wait for its end.
  bool is_in_transition() const noexcept { return transition_.is_on(); }
  /// @param recorded  in a replay, the parts that were separated on this tick
  const SimulatorOutput& tick(const SimulatorInput& input,
                              std::span<const RecordedSplit> recorded = {});
  const SimulatorOutput& output() const noexcept { return output_; }

  /// Voxels that the last tick emptied: first by the burr, then by the cut plane.
  std::span<const EmptiedIn> emptied() const noexcept { return emptied_; }
  /// Soft tissue that was torn on the last tick, in the bone's frame.
  std::span<const Tear> tears() const noexcept { return soft_.tears(); }
  const SoftTissue& soft_tissue() const noexcept { return soft_; }
  const Bleeding& bleeding() const noexcept { return bleeding_; }
  const LastInjury& last_injury() const noexcept { return injuries_.last(); }
  const Handpiece& handpiece() const noexcept { return handpiece_; }
  const Screws& screws() const noexcept { return screws_; }
  /// Shape of the burr in hand; null for another tool.
  const BurrShape* burr_shape() const noexcept;
  /// Balls of the burr in hand; none of another tool.
  std::span<const BurrShape::Ball> burr_balls() const noexcept;
  /// Null where nothing warms up.
  const DrillHeat* heat() const noexcept { return heat_ ? &*heat_ : nullptr; }
  /// Null where there is one hand.
  const TubeParameters* tube() const noexcept { return second_ ? &second_->parameters() : nullptr; }
  std::span<const WorldEvent> separations() const noexcept { return world_.events(); }
  std::span<const DustDeposit> deposits() const noexcept { return deposits_; }
  const DustTools& dust_tools() const noexcept { return dust_tools_; }

  const Camera& camera() const noexcept { return camera_; }
  /// How often kStill went down.
  std::int32_t stills_asked() const noexcept { return stills_asked_; }
  /// How a turning tool is to be drawn, a share of a turn: real speeds are far beyond any screen's.
  double shown_turn() const noexcept { return shown_turn_; }
  const ToolSpec& tool() const noexcept { return tools_[static_cast<std::size_t>(output_.tool)]; }
  std::span<const ToolSpec> tools() const noexcept { return tools_; }
  /// The model of a tool that is a plate; else null.
  const PlateModel* plate(int tool) const noexcept {
    return plates_[static_cast<std::size_t>(tool)].get();
  }
  std::span<const Structure> structures() const noexcept { return structures_; }
  BoneWorld& world() noexcept { return world_; }
  const BoneWorld& world() const noexcept { return world_; }

  /// Pieces that can be moved by themselves, the bone itself among them.
  int pieces() const noexcept;
  std::uint64_t emptied_so_far() const noexcept { return emptied_count_; }
  double amount_at_start() const noexcept { return start_; }   // of bone [voxels]
  double removed_so_far() const noexcept { return removed_; }  // by burrs and as crumbs [voxels]
  double cut_so_far() const noexcept { return cut_; }          // by the cut plane [voxels]
  /// Sum of all densities now; not the servo thread while it ticks. [voxels]
  double amount_left() const noexcept;
  /// Checksum of the density of every voxel and of its piece: the same for the same bone, however
  /// it is laid out in memory. Likewise.
  std::uint64_t checksum() const noexcept;

 private:
  struct Reach {  // of a piece's bricks, in B [m]
    Eigen::Vector3d low;
    Eigen::Vector3d high;

    bool is_near(const Eigen::Vector3d& p_B, double radius) const noexcept;
  };
  std::size_t in_hand() const noexcept { return static_cast<std::size_t>(output_.tool); }
  void take_separations(std::span<const RecordedSplit> recorded);
  void change_tool(int by) noexcept;
  HandMode mode_of(const SimulatorInput& input) const noexcept;
  void steer(const SimulatorInput& input) noexcept;
  void carry(const SimulatorInput& input) noexcept;
  void work(const SimulatorInput& input, std::uint32_t pressed) noexcept;
  void drill(const BurrTool& tool, const SimulatorInput& input) noexcept;
  void feel(const BurrTool& tool, const Contact& contact, double turning) noexcept;
  void yield(std::span<const BurrShape::Ball> balls, const SimulatorInput& input) noexcept;
  void work_second(const SimulatorInput& input) noexcept;
  void meet(const SimulatorInput& input) noexcept;
  void warm_up(const SimulatorInput& input) noexcept;
  void bleed(double dt) noexcept;
  void empty_soft(const Eigen::Vector3d& tip_B, double radius) noexcept;
  void begin_cut(CutPlane plane, const SimulatorInput& input) noexcept;
  void go_on_cutting() noexcept;
  void hold_plate(const SimulatorInput& input, bool fixes) noexcept;
  void place_for_dust(const SimulatorInput& input) noexcept;
  const Reach& reach_of(int piece) noexcept;

  std::vector<ToolSpec> tools_;
  std::vector<BurrTuning> before_;  // by tool, the transition
  ForceTransition transition_;
  MicroscopeParameters camera_parameters_;
  std::vector<Structure> structures_;
  BoneWorld world_;
  SoftTissue soft_;
  std::vector<std::unique_ptr<Drill>> drills_;       // by tool; null where it is no burr
  std::vector<std::unique_ptr<PlateModel>> plates_;  // likewise
  Shafts shafts_;
  Handpiece handpiece_;
  std::optional<SecondHand> second_;
  std::optional<DrillHeat> heat_;
  Bleeding bleeding_;
  InjuryWatch injuries_;
  CutPlaneTool cutter_;
  HeldBone carried_;
  Screws screws_;
  double cut_of_present_{0.0};
  Camera camera_;
  SimulatorOutput output_;
  std::uint32_t functions_{0};  // held on the last tick
  std::int32_t stills_asked_{0};
  double shown_turn_{0.0};
  Eigen::Vector3d hand_{Eigen::Vector3d::Zero()};
  bool hand_known_{false};
  bool waits_until_free_{true};
  std::array<Reach, kMaxPieces> reaches_;
  int reaches_known_{0};
  std::array<Contact, kMaxPieces> contacts_;
  std::vector<EmptiedIn> emptied_;
  std::vector<DustDeposit> deposits_;
  DustTools dust_tools_;
  std::uint64_t emptied_count_{0};
  double start_{0.0};
  double removed_{0.0};
  double cut_{0.0};
};

/// The pose of a tool.
Eigen::Isometry3d pose_of(const ToolState& tool) noexcept;

}  // namespace haptrial::bone
