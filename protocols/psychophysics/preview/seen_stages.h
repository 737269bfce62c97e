#pragma once

#include <vector>

#include "core/render/gl/image.h"
#include "protocols/psychophysics/preview/stage_words.h"

namespace haptrial::protocols {

struct PreviewedTrial;
struct TrialsDefinition;

/// Picture of what the participant sees.
struct SeenStage {
  std::vector<StagePlace> where;  // stages that look the same; none: a question
  int question{-1};               // from 0; -1: none
  render::Image picture;
};

/// Pictures of the stages and questions of a trial, by the drawing of sessions, off screen. The
/// hands are where the trial starts; bodies are at rest.
/// @param width  of a picture > 0; its height follows from [display] [px]
/// @throws RunError without an off-screen context
std::vector<SeenStage> seen_stages(const TrialsDefinition& definition, const PreviewedTrial& trial,
                                   int width);

}  // namespace haptrial::protocols
