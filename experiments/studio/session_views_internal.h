#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "experiments/studio/commands.h"
#include "experiments/studio/session_words.h"
#include "experiments/studio/study_folder.h"

namespace haptrial::experiments {

/// Answers to the page's requests about sessions with participants, devices and files for other
/// programs, each by a command of the program. Any thread. Throws as StudioViews does.
class SessionViews {
 public:
  /// @param folder, commands  outlive it
  SessionViews(const StudyFolder& folder, Commands& commands)
      : folder_(folder), commands_(commands) {}

  /// The checklist before a session: "checks", "ready", or "failure".
  nlohmann::json checklist(const SessionChoice& choice) const;
  /// Starts a session as a job.
  nlohmann::json begin(const SessionChoice& choice) const;
  /// Writes the emergency card beside the sessions. @returns its "file"
  nlohmann::json card(const SessionChoice& choice) const;
  /// The newest session that was started here, with its console's addresses while it runs; null
  /// if there is none.
  nlohmann::json session() const;

  /// Devices of this computer as rows of name, state and what was found.
  nlohmann::json devices() const;
  /// Tests a device as a job. @param seconds  1 to 600
  nlohmann::json test_device(const std::string& device, int seconds) const;
  /// Reads a device, or the channels of a definition, as a job. @param seconds  1 to 600
  nlohmann::json read_device(const std::string& device, int seconds) const;
  nlohmann::json read_channels(const std::string& file, int seconds) const;

  /// Writes a folder of sessions in another format as a job.
  /// @param format  "csv", "bids" or "pdf"
  nlohmann::json hand_over(const std::string& file, const std::string& folder,
                           const std::string& format) const;

  /// Lists the files that a participant's withdrawal deletes from the sessions and exports of a
  /// study. @param sure  deletes them
  nlohmann::json withdraw(const std::string& file, const std::string& subject, bool sure) const;

 private:
  const StudyFolder& folder_;
  Commands& commands_;
};

}  // namespace haptrial::experiments
