#pragma once

#include <vector>

#include "core/bone/record/drilling_tables.h"
#include "core/record/rows/session_types.h"
#include "core/record/table/table_description.h"
#include "tests/support/temporary_folder.h"

namespace haptrial::test {

record::SessionInfo example_info();

/// Samples of a participant's hand: a smooth curve at 16 mm/s with tremor, read by an encoder with
/// steps of 1e-5 m, velocity from a first-order filter, forces smooth with noise, passes of 18 s.
std::vector<record::Sample> hand_motion(std::size_t count, std::uint64_t seed);

/// The row as it must come back: each value on the grid of its column, computed with
/// std::nearbyint.
record::Sample on_file(const record::Sample& sample);

/// 3 x 4 x 2 voxels, of which (1, 0, 0), (2, 0, 0) and (2, 3, 1) hold something.
record::BoneRecord small_bone();
/// Every table that a file of these tests may have beside those of every session.
record::TableList drilling_and_common();

/// Rows of a tool on as many ticks, with another value in every field of every row.
std::vector<record::ToolRow> tool_motion(std::size_t count, std::uint64_t seed);

bool same(const record::Sample& a, const record::Sample& b);

}  // namespace haptrial::test
