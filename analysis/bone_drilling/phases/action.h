#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/bone_drilling/metrics/procedure.h"
#include "analysis/bone_drilling/metrics/study_bones.h"

namespace haptrial::analysis::drilling {

/// Facts about an action that are words, and those that are numbers.
enum class ActionWord : std::size_t { kTool, kStructure, kView };
inline constexpr std::size_t kActionWords = 3;
enum class ActionNumber : std::size_t { kDepth, kClearance, kForce, kSpeed, kSeen };
inline constexpr std::size_t kActionNumbers = 5;

/// The names of these facts in files.
inline constexpr std::array<std::string_view, kActionWords> kActionWordNames{"tool", "structure",
                                                                             "view"};
inline constexpr std::array<std::string_view, kActionNumbers> kActionNumberNames{
    "depth", "clearance", "force", "speed", "seen"};

/// The unit in which phases are recognised: a stroke and the break after it, or about a second
/// without a stroke. The actions of a procedure follow one another and fill it.
///
/// Words: tool in hand, with " at work" while it strokes; nearest vital structure within a
/// centimetre; whether the view moved. Numbers: depth of the tip below the surface that the bone
/// had [mm]; distance from that structure, at most 10 [mm]; log of the force in newtons and of the
/// speed in millimetres a second; log of the height of what is seen, in millimetres.
struct Action {
  std::size_t first{0}, last{0};  // ticks of the procedure, both inclusive
  std::array<std::string, kActionWords> words;
  std::array<double, kActionNumbers> numbers{};

  std::string& word(ActionWord which) { return words[static_cast<std::size_t>(which)]; }
  double& number(ActionNumber which) { return numbers[static_cast<std::size_t>(which)]; }
};

/// The actions of a procedure; none without ticks. Any thread.
/// @param bones  of which depth and distances are those before anything was drilled
std::vector<Action> actions_of(const Procedure& procedure, StudyBones& bones);

}  // namespace haptrial::analysis::drilling
