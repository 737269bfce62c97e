#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/definition/bounds.h"
#include "core/base/definition/schema.h"
#include "core/control/pd_controller.h"
#include "core/scene/field.h"

namespace haptrial::scene {

// Bounds of quantities that many fields have.
inline constexpr Bounds kPlaceBounds{-1.0, 1.0};             // [m]
inline constexpr Bounds kLengthBounds{0.0, 1.0, true};       // [m]
inline constexpr Bounds kForceBounds{-100.0, 100.0};         // [N]
inline constexpr Bounds kStrengthBounds{0.0, 100.0};         // [N]
inline constexpr Bounds kStiffnessBounds{0.0, 1e5};          // [N/m]
inline constexpr Bounds kDampingBounds{0.0, 1e4};            // [N·s/m]
inline constexpr Bounds kDurationBounds{0.0, 3600.0, true};  // [s]
inline constexpr Bounds kFadeBounds{0.0, 60.0};              // [s]
inline constexpr Bounds kFilterBounds{0.0, 1e5, true};       // [Hz]

/// Description of a direction that many kinds have.
inline constexpr const char* kNormal =
    "Direction across a plane or a texture's waves; of a wall or half space out of it";

/// Numbers of the loop and the field that bounds of its keys may depend on.
struct FieldSetting {
  double rate{1000.0};                // of the servo loop [Hz]
  double limit{10.0};                 // of the field [N]
  std::vector<std::string> values{};  // of channels, which it may follow
};

/// One kind of [fields]: what its `type` says, and how its keys are read.
struct KindOfField {
  std::string word;
  /// Problems are noted in the table.
  std::function<FieldKind(Table& table, const FieldSetting& setting)> read;
  double fade{0.05};     // fade_in and fade_out if none are given >= 0 [s]
  bool has_limit{true};  // false: it gives no force of its own
};

/// Every kind that read_field() knows. Call before threads are started.
const std::vector<KindOfField>& kinds_of_field();

/// Adds a kind of a program's own; its read() gives RegisteredParameters.
/// @throws std::invalid_argument for a word that is taken
void add_kind_of_field(const KindOfField& kind);

// Keys that many kinds of fields and objects have.

/// stiffness and damping
const Schema<control::PdGains>& field_gains_schema();
/// limit
const Schema<Field>& field_limit_schema();
/// fade_in and fade_out
const Schema<Field>& field_fade_schema();

}  // namespace haptrial::scene
