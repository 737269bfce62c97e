#pragma once

namespace haptrial::experiments {

/// Words after this one belong to another program, to the end of the line, whatever they begin
/// with. The command line makes one word of them, with kProgramSeparator in between.
inline constexpr const char* kProgramOption = "--program";
inline constexpr char kProgramSeparator = '\x1f';

}  // namespace haptrial::experiments
