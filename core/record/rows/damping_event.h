#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace haptrial::record {

/// The kind of event of a pass during whose run the hand did not carry all the damping.
inline constexpr const char* kDampingReduced = "damping_reduced";

struct DampingReduced {
  int trial{0};
  double least{1.0};    // share of the damping that the definition asks for
  double seconds{0.0};  // of the run, for which it was reduced [s]
};

/// As /events says it: "trial 3: damping fell to 0.052 of the definition's, and was reduced for
/// 1.250 s of the run".
std::string to_text(const DampingReduced& damping);

/// The three numbers of such a text, also as older versions wrote it; nothing where they are not
/// there.
std::optional<DampingReduced> damping_reduced_of(std::string_view text);

}  // namespace haptrial::record
