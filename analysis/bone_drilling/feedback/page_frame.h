#pragma once

#include <string>
#include <string_view>

namespace haptrial::analysis::drilling {

/// The parts that pages of procedures and of trainees share.

/// A whole page of HTML that may load nothing from anywhere. @param body  HTML
std::string whole_page(std::string_view title, bool simulated, std::string_view body);

/// A banner with a text that must not be overlooked. @param text  is escaped
std::string banner(std::string_view text);
std::string paragraph(std::string_view text);
std::string heading(std::string_view text);

/// The sentence of every page with a simulated participant or expert. Empty if neither is.
std::string simulated_banner(bool participant, bool experts);

}  // namespace haptrial::analysis::drilling
