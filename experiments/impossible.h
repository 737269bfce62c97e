#pragma once

namespace haptrial {
class Table;
}

namespace haptrial::experiments {

struct BoneDefinition;
struct Definition;

/// Notes what no session could do: frequencies that the rate of the loop cannot carry at all,
/// movements that the envelope would end, a score that is 0 for everybody. Only for definitions
/// that are about to be used: a recorded session is a fact, whatever its definition says.
void reject_impossible(Table& root, const Definition& definition);
void reject_impossible(Table& root, const BoneDefinition& definition);

}  // namespace haptrial::experiments
