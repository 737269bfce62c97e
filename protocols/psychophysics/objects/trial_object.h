#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/contact/felt_body.h"
#include "core/deformable/springs/spring_body.h"
#include "core/deformable/touch/haptic_mesh.h"

namespace haptrial::protocols {

/// The shape of a table [objects.NAME]: the same in every trial.
struct TrialObject {
  std::string name;
  std::filesystem::path file;  // of a mesh; empty: a shape that the definition describes
  contact::SharedBody body;    // of a file: null until it is loaded
  std::uint64_t file_bytes{0}, file_checksum{0};  // likewise; the checksum is FNV-1a
  bool recorded{false};                           // its contacts, tick by tick, in /contacts
  bool yields{false};                             // gives way to the hand
  int cells{16};                                  // then: along its longest side
  deformable::FeltSides sides{};
  deformable::SharedHapticMesh felt{};     // of a file: null until it is loaded
  bool seen_yielding{true};                // else it is seen at its resting shape
  bool moves{false};                       // it yields and moves
  bool own_rate{false};                    // and moves at another rate than the loop's
  std::filesystem::path constants_file{};  // of springs; empty: none
  std::shared_ptr<const deformable::SpringConstants> constants{};  // of it; null until loaded
  std::uint64_t constants_bytes{0}, constants_checksum{0};         // likewise
};

/// Reads the shapes of [objects], in the order of their names. Problems are noted.
///
/// Lengths are in metres, numbers alone: what changes between trials is the object's scale, centre
/// and turn, which read_rigid() or read_deformable() reads with all else.
std::vector<TrialObject> read_objects(Table& objects);

/// Reads the meshes and constants that are files. @param folder  of the definition
/// @throws InputError as read_mesh() and FeltBody do, naming the object
void load_objects(std::vector<TrialObject>& objects, const std::filesystem::path& folder);

inline constexpr std::size_t kMostSeenObjects = 2;  // in a stage

/// An object that a stage shows, where it is. Plain data, for the screen.
struct SeenObject {
  std::array<float, 3> centre{};          // in W [m]
  std::array<float, 4> turn{1, 0, 0, 0};  // w, x, y, z
  float scale{1.0F};
  std::int32_t object{-1};  // of the definition's, from 0
  std::int32_t body{-1};    // number in SeenBodies; -1: it is seen at its resting shape

  bool operator==(const SeenObject&) const = default;
};

}  // namespace haptrial::protocols
