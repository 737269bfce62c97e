#include "experiments/command/sessions/meet_partner.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <utility>

#include "core/base/definition/definition_changes.h"
#include "core/base/error.h"
#include "core/tutoring/link_thread.h"
#include "core/tutoring/meeting.h"
#include "core/tutoring/secret.h"
#include "experiments/command/arguments.h"
#include "experiments/control/signals.h"
#include "experiments/runner/version.h"
#include "protocols/interface/study_rules.h"

namespace haptrial::experiments {
namespace {

/// All that both sides' presentation follows from. Each side has its own room, devices and texts.
std::vector<tutoring::SharedTerm> shared_terms(const SessionRequest& request,
                                               const protocols::Definition& definition) {
  const DefinitionRules rules = protocols::study_rules(*request.protocol, protocols::Hand::kPerson);
  return {{"definition", binding_text(definition.text, rules)},
          {"version of the program", program_version()},
          {"subject", request.subject},
          {"participant", fmt::to_string(request.participant)},
          {"session", fmt::to_string(request.session)},
          {"seed", fmt::to_string(request.seed)},
          {"number of trials", fmt::format("{}", request.max_trials)}};
}

void say(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

}  // namespace

std::optional<protocols::LinkChoice> meet_partner(const RunOptions& options,
                                                  const SessionRequest& request,
                                                  const protocols::Definition& definition) {
  if (!options.teach && options.learn_from.empty()) {
    return std::nullopt;
  }
  const tutoring::Secret secret = tutoring::Secret::read(options.secret);
  tutoring::MeetingRequest meeting;
  meeting.guest_of = options.learn_from;
  meeting.shared = shared_terms(request, definition);
  meeting.pulse = [] {
    if (interrupted()) {
      throw RunError("interrupted");
    }
  };
  meeting.notice = say;
  if (options.teach) {
    meeting.port =
        static_cast<std::uint16_t>(checked_number("--teach", *options.teach, 1024, 65535));
    say(fmt::format("waiting at port {} for the side that learns", meeting.port));
  }
  tutoring::EstablishedLink met = tutoring::meet(secret, meeting);
  protocols::LinkChoice link;
  link.role = options.teach ? protocols::LinkRole::kTeaches : protocols::LinkRole::kLearns;
  link.session = fmt::format("{:016x}", met.keys.session);
  link.wire = std::make_shared<tutoring::LinkThread>(std::move(met));
  say(fmt::format("linked: this side {}", protocols::name_of(link.role)));
  return link;
}

}  // namespace haptrial::experiments
