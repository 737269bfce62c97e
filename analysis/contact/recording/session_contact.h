#pragma once

#include <optional>
#include <string>

#include "analysis/contact/recording/streams.h"
#include "core/record/read/session_reader_forward.h"

namespace haptrial::evaluation {

/// Which contacts of a session are taken.
struct SessionChoice {
  std::optional<std::string> object;  // [objects.NAME]; default: the only one that was touched
  std::optional<int> trial;           // from 1; default: the first one in which it was touched
};

/// The contacts of one trial with one object, as a recording that needs neither load nor lag.
struct SessionContact {
  std::string object;
  int trial{0};
  bool simulated{false};
  double tool_radius{0.0};     // of the object in the recorded definition; 0: a point [m]
  ContactRecording recording;  // in the world's frame; half a second of air before and after
};

/// Reads the contacts that `record = true` of an object keeps (/contacts): the pose is that of the
/// proxy, or of the tool in the air, the force is the object's alone. The tool is that of the
/// device by which the object is felt.
/// @throws InputError where the session recorded no such contact, naming what there is.
SessionContact read_session_contact(const record::SessionReader& session,
                                    const SessionChoice& choice);

}  // namespace haptrial::evaluation
