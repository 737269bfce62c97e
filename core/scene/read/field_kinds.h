#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/definition/schema.h"
#include "core/control/pd_controller.h"
#include "core/scene/field.h"
#include "core/scene/read/field_bounds.h"

namespace haptrial::scene {

/// Numbers of the loop and the field that bounds of its keys may depend on.
struct FieldSetting {
  double rate{1000.0};  // of the servo loop [Hz]
  double limit{10.0};   // of the field [N]
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
