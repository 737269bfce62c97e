#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/bone/record/bone_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/bone/simulator/simulator.h"

// A tick of a drilling that is simulated again beside the rows that the session wrote on it. Each
// function gives a sentence, which is empty if both are the same.
namespace haptrial::protocols {

/// The voxels that a tick emptied, in any order: while a part comes off, a session looks at it
/// after the bone that it leaves, and the search for parts came to it when its thread had time.
std::string difference(std::uint64_t sequence, std::span<const record::RemovalRow> recorded,
                       std::span<const bone::EmptiedIn> emptied);

/// The tears of a tick, to the bit.
std::string difference(std::uint64_t sequence, std::span<const record::TearRow> recorded,
                       std::span<const bone::Tear> torn);

/// The places of the pieces of a tick's rows, to the bit.
std::string difference(std::uint64_t sequence, std::span<const record::PieceRow> recorded,
                       const bone::Simulator& simulator);

/// The hold of the screws of a tick's rows, to the bit.
std::string difference(std::uint64_t sequence, std::span<const record::ScrewRow> recorded,
                       const bone::Screws& screws);

}  // namespace haptrial::protocols
