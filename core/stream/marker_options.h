#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/definition/schema_forward.h"
#include "core/stream/onset_log.h"

namespace haptrial::markers {

/// Options of [markers] in a definition. Codes are of the first of their kind; the others count on.
struct MarkerOptions {
  bool used{false};    // a session records its markers
  std::string serial;  // a serial line, such as /dev/ttyUSB0; empty: none
  int baud{115200};
  std::string neon;     // address of a Pupil Labs Neon's phone; empty: none
  double pulse{0.005};  // for which a code stands on the line >= 0 [s]; 0: it stays
  int trial{1};
  int interval{11};
  int stage{21};
  int response{101};
  /// Onsets that are sent on the serial line; those of one tick in this order.
  std::vector<record::MarkerOf> send{record::MarkerOf::kStage, record::MarkerOf::kResponse,
                                     record::MarkerOf::kInterval, record::MarkerOf::kTrial};
};

/// The keys of [markers].
const Schema<MarkerOptions>& marker_schema();

/// Meaning of a code.
struct MarkerMeaning {
  record::MarkerOf what{record::MarkerOf::kTrial};
  std::int16_t index{0};  // as Onset::index
  std::string name;
  int code{0};
};

/// Notes codes outside 1 to 255, and two meanings of one code. @param key  the table that the
/// sentences name
void check_meanings(Table& root, const char* key, const std::vector<MarkerMeaning>& meanings);

/// "trial 1, stage press 21, response yes 101".
std::string words_of(const std::vector<MarkerMeaning>& meanings);

/// The meaning of an onset; null if there is none.
const MarkerMeaning* meaning_of(const std::vector<MarkerMeaning>& meanings, const Onset& onset);

}  // namespace haptrial::markers
