#pragma once

#include <functional>
#include <memory>
#include <string>

#include "protocols/definition/tutoring_options.h"
#include "protocols/interface/trials.h"
#include "protocols/tutoring/model_motion.h"

namespace haptrial::protocols {

/// Trials of any protocol whose first phase is led by what somebody did in a recorded run
/// (haptic playback; source: Morris 2006, §3.4.1): while the pass runs, the tool is held to the
/// tutor's by a spring of low gain, and the tutor's forces are played. What the own pass would give
/// is faded out meanwhile, and comes back at the end of the recording. What the tutor did is
/// recorded in /tutoring, tick by tick.
/// @param definition  the session's, as text: a recording by another one is said in a notice
/// @param led  whether a trial is led, by its number; practice has 0
std::unique_ptr<Trials> tutored(std::unique_ptr<Trials> trials, const TutoringOptions& options,
                                const TutorChoice& tutor, const std::string& definition,
                                std::function<bool(int trial)> led);

}  // namespace haptrial::protocols
