#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/scene/field.h"
#include "protocols/psychophysics/preview/stage_words.h"

namespace haptrial::protocols {

struct PreviewedTrial;
struct TrialsDefinition;

/// Fields that act on one device, as a scene has them, without fades: what is felt once a stage has
/// gone on for a while.
struct FeltFields {
  std::vector<scene::Field> fields;
  std::uint64_t mask{0};  // those that act, a bit each
  double rate{1000.0};    // of the servo loop [Hz]
};

/// Forces on a hand that is led through places and is at rest at each: one tick of a scene a place,
/// in their order. @param way  places in W [m]
/// @returns (places) [N]
std::vector<Eigen::Vector3d> forces_along(const FeltFields& felt,
                                          std::span<const Eigen::Vector3d> way);
/// Force on a hand that stays at a place with a velocity, once filters have settled (0.1 s, or
/// sooner where nothing changes any more).
/// @param place  in W [m]  @param velocity  [m/s]
Eigen::Vector3d settled_force(const FeltFields& felt, const Eigen::Vector3d& place,
                              const Eigen::Vector3d& velocity);
/// Forces on a hand that is held at a place, tick by tick. @returns (ticks) [N]
std::vector<Eigen::Vector3d> forces_over_time(const FeltFields& felt, const Eigen::Vector3d& place,
                                              std::size_t ticks);

/// Force along a line through a place, parallel to an axis of W, on a hand that is led from the
/// place to either end.
struct ForceLine {
  int axis{0};                          // 0, 1, 2: x, y, z
  std::vector<double> offsets;          // from the place, ascending [m]
  std::vector<Eigen::Vector3d> forces;  // (offsets) [N]
};

/// Force in a plane through a place, row by row, on a hand that is led from the place to the row
/// and along it.
struct ForcePlane {
  int across{0}, up{1};  // axes of W
  std::size_t columns{0};
  std::vector<Eigen::Vector3d> places;  // (rows x columns) [m]
  std::vector<Eigen::Vector3d> forces;  // likewise [N]
};

/// How the force changes with the velocity along an axis: beyond the force at rest.
struct SpeedCurve {
  int axis{0};
  std::vector<double> speeds;           // ascending [m/s]
  std::vector<Eigen::Vector3d> forces;  // (speeds) [N]
};

/// The demands of a field on the loop, in numbers.
struct FieldNumbers {
  std::string name;
  std::string type;       // as the definition says it
  double stiffness{0.0};  // bound on the change of force over place; infinite: a jump [N/m]
  double damping{0.0};    // bound on the change of force over velocity [N·s/m]
  bool passive{false};
  double needed{0.0};                  // damping of device and hand that a slow hand needs [N·s/m]
  double limit{0.0};                   // [N]
  double fade_in{0.0}, fade_out{0.0};  // [s]
};

/// The feeling of a stage; stages that feel the same share one.
struct FeltStage {
  std::vector<StagePlace> where;
  std::size_t device{0};
  FeltFields felt;
  std::vector<FieldNumbers> fields;
  Eigen::Vector3d origin{Eigen::Vector3d::Zero()};  // of lines and plane, in W [m]
  std::array<ForceLine, 3> lines;
  ForcePlane plane;
  Eigen::Vector3d touched{Eigen::Vector3d::Zero()};   // place of `course`, in W [m]
  Eigen::Vector3d moved_at{Eigen::Vector3d::Zero()};  // place of `speeds`, in W [m]
  std::array<SpeedCurve, 3> speeds;
  std::vector<Eigen::Vector3d> course;  // (ticks) at `touched`; empty: it does not change [N]

  bool is_felt() const;         // some force along a line, over speed or time
  bool resists_motion() const;  // some force changes with the velocity
};

/// Where the forces of stages are looked at.
struct FeltLook {
  std::optional<Eigen::Vector3d> through{};   // of lines and plane; none: the start, in W [m]
  std::optional<std::array<int, 2>> plane{};  // axes across and up; none: where most changes
};

/// The feeling of the stages of a trial, on each device that is a tip; stages without a field are
/// left out. Bodies that give way are prepared, which may take long.
/// @throws InputError as prepare_bodies()
std::vector<FeltStage> felt_stages(const TrialsDefinition& definition, const PreviewedTrial& trial,
                                   const FeltLook& look = {});

}  // namespace haptrial::protocols
