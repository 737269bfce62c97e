#include "analysis/quality/quality_columns.h"

namespace haptrial::analysis {

std::span<const QualityColumn> quality_columns() {
  using Q = TrialQuality;
  static constexpr QualityColumn kColumns[] = {
      {"duration", "s", "of the test's run", [](Q & q) -> auto& {return q.test.duration;
}
}  // namespace haptrial::analysis
, {"lag", "s", "of the hand behind the moving target; empty at the participant's own pace",
   [](Q& q) -> auto& {return q.lag;
}
}
, {"peak_force", "N", "largest applied force of the test",
   [](Q& q) -> auto& {return q.test.peak_force;
}
}
, {"saturation", "", "share of the test's ticks at the force limit",
   [](Q& q) -> auto& {return q.test.saturation;
}
}
, {"training_saturation", "", "share of the training's ticks at the force limit",
   [](Q& q) -> auto& {return q.training.saturation;
}
}
, {"oscillation", "",
   "share of the test in which the force swung by 2 N or more at 10 Hz or faster",
   [](Q& q) -> auto& {return q.test.oscillation;
}
}
, {"oscillation_frequency", "Hz", "of these swings; empty if there are none",
   [](Q& q) -> auto& {return q.test.oscillation_frequency;
}
}
, {"training_oscillation", "", "share of the training in which the force swung so",
   [](Q& q) -> auto& {return q.training.oscillation;
}
}
, {"reduced_damping", "", "share of the test with less damping than the definition asks for",
   [](Q& q) -> auto& {return q.test.reduced_damping;
}
}
, {"missing_ticks", "", "share of the test's ticks that were not made",
   [](Q& q) -> auto& {return q.test.missing_ticks;
}
}
, {"late_ticks", "", "share of the test's ticks that came half a period late or later",
   [](Q& q) -> auto& {return q.test.late_ticks;
}
}
, {"top_speed", "m/s", "between two ticks of the test, from the positions",
   [](Q& q) -> auto& {return q.test.top_speed;
}
}
, {"dropped_frames", "", "share of the screen's refreshes in the test without a new picture",
   [](Q& q) -> auto& {return q.test.dropped_frames;
}
}
, {
  "training_dropped_frames", "", "the same in the training", [](Q & q) -> auto& {
    return q.training.dropped_frames;
  }
}
}
;
return kColumns;
}

}  // namespace haptrial::analysis
