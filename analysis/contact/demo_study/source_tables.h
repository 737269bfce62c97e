#pragma once

#include <array>

namespace haptrial::evaluation {

// Morris 2006, Tables 4 to 6, "RMS force error" [N].
inline constexpr std::array kSourceTable4{0.136, 0.130, 0.129};
inline constexpr std::array kSourceTable5{0.132, 0.067};
inline constexpr std::array kSourceTable6{0.085, 0.031, 0.031, 0.022, 0.022, 0.015, 0.013, 0.009};

}  // namespace haptrial::evaluation
