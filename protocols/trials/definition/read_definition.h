#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "core/scene/field.h"
#include "core/scene/read/read_shape.h"
#include "protocols/trials/definition/trials_definition.h"
#include "protocols/trials/language/names.h"
#include "protocols/trials/looks/look.h"
#include "protocols/trials/stages/read_stages.h"

namespace haptrial {
class RandomStream;
class Table;
}  // namespace haptrial

namespace haptrial::protocols {

/// What an interval consists of once every name has a value.
struct Presented {
  std::vector<scene::Field> fields;
  std::vector<std::uint64_t> felt;  // (devices) the fields that act on each, a bit each
  std::vector<scene::Region> regions;
  std::vector<std::size_t> region_devices;  // (regions) whose tool it is asked of, from 0
  std::vector<Look> looks;
  std::vector<NamedStage> stages;
};

/// The document of a definition again, with what it need not state.
Table parsed_trials(const Definition& definition);

/// The names of a definition, ready to be given values.
std::unique_ptr<Names> read_names(Table& root, const TrialsDefinition& definition);

/// What is presented with the values that the names have. Problems are noted.
/// @param random  for durations; null: the shortest
Presented read_presented(Table& root, const Names& names, const TrialsDefinition& definition,
                         RandomStream* random);

/// The choice that is right with the values that the names have, from 0.
/// @throws InputError for a value that is no choice's number or word
int right_choice(const Names& names, const Question& question);

/// Reads everything but who stands in for people. Problems are noted.
void read_trials_definition(Table& root, std::string_view file_name, TrialsDefinition& definition);

}  // namespace haptrial::protocols
