#pragma once

// Okabe and Ito's palette, told apart with any colour vision; dashes and shapes tell series apart
// without any.
namespace haptrial::analysis::palette {

inline constexpr const char* kBlue = "#0072b2";
inline constexpr const char* kOrange = "#d55e00";
inline constexpr const char* kGreen = "#009e73";
inline constexpr const char* kPurple = "#cc79a7";
inline constexpr const char* kGrey = "#9aa0a6";
inline constexpr const char* kPale = "#c8ccd0";
inline constexpr const char* kBlack = "#1a1a1a";

inline constexpr const char* kSolid = "solid";
inline constexpr const char* kLong = "(9,4)";
inline constexpr const char* kMixed = "(9,4,2,4)";
inline constexpr const char* kShort = "(3,3)";

}  // namespace haptrial::analysis::palette
