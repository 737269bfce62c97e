#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace haptrial::protocols {
class Protocol;
}

namespace haptrial::experiments {

/// Compares the definitions of a study's sessions, of each also those that it was resumed with.
/// @param protocol  of the study
/// @returns a sentence for each way in which they differ that may, for the report
/// @throws InputError when two differ in what was presented, recorded or scored; names the keys.
std::vector<std::string> definition_remarks(const protocols::Protocol& protocol,
                                            const std::vector<std::filesystem::path>& files);

}  // namespace haptrial::experiments
