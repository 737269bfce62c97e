#pragma once

#include <string>
#include <vector>

#include "core/scene/field.h"
#include "core/scene/read/field_reader.h"

namespace haptrial::scene {

/// One kind of [fields]: what its `type` says, and how its keys are read.
struct KindOfField {
  std::string word;
  FieldKind (*read)(const FieldReader&);  // problems are noted in the table
  double fade{0.05};                      // fade_in and fade_out if none are given >= 0 [s]
};

/// Every kind that read_field() knows. Call before threads are started.
const std::vector<KindOfField>& kinds_of_field();

/// Adds a kind of a program's own; its read() gives RegisteredParameters.
/// @throws std::invalid_argument for a word that is taken
void add_kind_of_field(const KindOfField& kind);

}  // namespace haptrial::scene
