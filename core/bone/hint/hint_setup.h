#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/definition/given_in.h"
#include "core/base/definition/schema_forward.h"
#include "core/bone/hint/safe_limits.h"

namespace haptrial::hint {

/// Reason of a hint: more force than safe near a structure; a faster tip; bone that other bone
/// hides is removed.
enum class HintKind : std::uint8_t { kForce, kSpeed, kHidden };
inline constexpr std::array kAllHintKinds{HintKind::kForce, HintKind::kSpeed, HintKind::kHidden};
inline constexpr std::size_t kHintKinds = kAllHintKinds.size();
/// Name of a kind in definitions and files: "force", "speed", "hidden".
std::string_view name_of(HintKind kind) noexcept;
constexpr std::uint8_t bit(HintKind kind) noexcept {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(kind));
}

/// The condition of trials with hints: "hints on".
inline constexpr const char* kHints = "hints";

/// Hints of a definition. They are recorded in all trials and shown in some.
struct HintSetup {
  std::string file;                      // with safe limits, beside the definition; may be empty
  std::array<bool, kHintKinds> kinds{};  // that are given
  GivenIn shown{GivenIn::kAll};          // trials in which the participant sees them
  double reach{5e-3};                    // of structures, within which limits count > 0 [m]
  int fewest{3};                         // faulty removals that begin a hint >= 1
  double within{0.25};                   // in which they come > 0 [s]
  double holds{1.0};                     // after the last of them > 0 [s]
  bool sound{false};                     // a chime when a hint begins
  std::array<std::string, kHintKinds> texts;  // {structure} stands for the nearest one's name
  SafeLimits limits;                          // of the file, once it is loaded

  bool gives(HintKind kind) const noexcept { return kinds[static_cast<std::size_t>(kind)]; }
  bool needs_limits() const noexcept { return gives(HintKind::kForce) || gives(HintKind::kSpeed); }
};

/// The keys of [hints]; the file of limits is not looked at.
const Schema<HintSetup>& hint_schema();

/// Reads the file of limits, if there is one. @param folder  of the definition
/// @throws InputError where the file is missing, and as load_safe_limits() does.
void load_limits(HintSetup& setup, const std::filesystem::path& folder);

/// The text of a hint for a participant.
std::string hint_text(const HintSetup& setup, HintKind kind, std::string_view structure);

}  // namespace haptrial::hint
