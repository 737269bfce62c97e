#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/record/rows/rows.h"

namespace haptrial::record {

/// How the present trial stands, in words and numbers for people.
struct LiveState {
  struct Figure {
    std::string name;   // "Bone removed"
    std::string value;  // "12.5 mm3"
    bool alarm{false};  // somebody should look
    bool operator==(const Figure&) const = default;
  };
  /// A trial of the procedure that is asked now.
  struct TrackPoint {
    double level{0.0};
    int correct{-1};  // 1 right, 0 wrong, -1 not known
    bool operator==(const TrackPoint&) const = default;
  };
  int trial{0};  // from 1; 0 of practice
  bool practice{false};
  std::string title;  // "Procedure 3"
  std::vector<Figure> figures;
  std::string track_name;         // empty: no procedure is asked
  std::vector<TrackPoint> track;  // its trials so far
  std::string line;               // all of it in one line, for a terminal
  bool operator==(const LiveState&) const = default;
};

/// Figures of a session while it runs, from what it records. They never hold the session up: who
/// computes much has a thread of its own.
class LiveFigures : public Sink {
 public:
  /// Waits until everything that was given is counted. Nothing more after that.
  virtual void finish() {}
  /// Any thread: the present trial, or the last one; nothing before the first.
  virtual std::optional<LiveState> now() const = 0;
  /// Any thread: all trials but practice, in order.
  virtual std::vector<LiveState> done() const = 0;
  /// Any thread: why they have ceased, in a sentence; empty while they go on.
  virtual std::string trouble() const { return ""; }
};

}  // namespace haptrial::record
