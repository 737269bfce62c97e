#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/record/byte_planes.h"
#include "core/record/session_types.h"

namespace haptrial::record {

/// Rows of the session types to and from the planes of a chunk, in the column order of schema.h.
/// put_* write rows.size() rows from row `at` on; get_* read the rows [at, at + count).
/// @throws std::invalid_argument for a text that does not fit its column or holds a NUL byte.
void put_samples(BytePlanes& planes, std::size_t at, std::span<const Sample> rows);
void put_pass(BytePlanes& planes, std::size_t at, const PassRow& row);
void put_stimulus(BytePlanes& planes, std::size_t at, const StimulusRow& row);
void put_timing(BytePlanes& planes, std::size_t at, const TimingRow& row);
void put_frame(BytePlanes& planes, std::size_t at, const FrameRow& row);

void get_samples(const BytePlanes& planes, std::size_t at, std::span<Sample> rows);
PassRow get_pass(const BytePlanes& planes, std::size_t at);
PassRow get_pass_1(const BytePlanes& planes, std::size_t at);  // of schema version 1
StimulusRow get_stimulus(const BytePlanes& planes, std::size_t at);
TimingRow get_timing(const BytePlanes& planes, std::size_t at);
FrameRow get_frame(const BytePlanes& planes, std::size_t at);

/// A row of /events: a text longer than its column goes on in the next rows, cut between
/// characters.
struct EventPart {
  EventRow row;
  std::int32_t part{0};
};
std::vector<EventPart> event_parts(const EventRow& row);
void put_event(BytePlanes& planes, std::size_t at, const EventPart& part);
EventPart get_event(const BytePlanes& planes, std::size_t at);
/// Events from their rows, in order. @param parts  a part above 0 without its beginning stands
/// alone
std::vector<EventRow> joined_events(std::vector<EventPart> parts);
/// A row of /attributes: like one of /events without a time; row.kind is the name.
void put_attribute(BytePlanes& planes, std::size_t at, const EventPart& part);
EventPart get_attribute(const BytePlanes& planes, std::size_t at);

/// The phase that a text of /trials names.
Phase phase_of(std::string_view name);

/// The columns that the analysis of a pass needs, doubles from the 32-bit values on file.
void get_column_i64(const BytePlanes& planes, std::size_t offset, std::size_t at,
                    std::span<std::int64_t> values);
/// @param stride  distance of consecutive results in `values` (3 fills one row of a 3 x n matrix).
void get_column_f32(const BytePlanes& planes, std::size_t offset, std::size_t at, std::size_t count,
                    double* values, std::size_t stride);

}  // namespace haptrial::record
