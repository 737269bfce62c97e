#include "analysis/contact/recording/session_contact.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"
#include "core/record/rows/device_rows.h"
#include "core/record/rows/object_rows.h"

namespace haptrial::evaluation {
namespace {

using record::ContactRow;
using record::PassRow;

constexpr double kAir = 0.5;  // before the first and after the last contact [s]
constexpr double kNanoseconds = 1e-9;

Table definition_of(const record::SessionReader& session) {
  return Table::parse(session.info().definition, session.info().definition_name);
}

/// The objects of the definition in the order of their names, as /contacts numbers them.
std::vector<std::string> objects_of(const record::SessionReader& session) {
  Table root = definition_of(session);
  return root.has("objects") ? root.table("objects").keys() : std::vector<std::string>();
}

/// The radius of the ball by which an object is felt [m].
double tool_radius_of(const record::SessionReader& session, const std::string& object) {
  return definition_of(session).table("objects").table(object).number_or("tool_radius", 0.0,
                                                                         {0.0, 0.05}, "m");
}

std::vector<ContactRow> contacts_of(const record::SessionReader& session) {
  std::vector<ContactRow> contacts = session.rows<ContactRow>();
  if (contacts.empty()) {
    throw InputError(
        fmt::format("{}: no contact is recorded; an object's contacts are if it says record = true",
                    session.path().string()));
  }
  return contacts;
}

/// Leaves the contacts with one object. @returns its name
std::string choose_object(const record::SessionReader& session, const SessionChoice& choice,
                          std::vector<ContactRow>& contacts) {
  const std::vector<std::string> names = objects_of(session);
  std::set<std::string> touched;
  const auto name_of = [&](const ContactRow& row) {
    return names.at(static_cast<std::size_t>(row.object));
  };
  for (const ContactRow& row : contacts) {
    touched.insert(name_of(row));
  }
  const bool one = touched.size() == 1;
  if ((!choice.object && !one) || (choice.object && !touched.contains(*choice.object))) {
    throw InputError(fmt::format(
        "{}: --object is {}; contacts are recorded with: {}", session.path().string(),
        choice.object ? "'" + *choice.object + "'" : "missing", fmt::join(touched, ", ")));
  }
  const std::string name = choice.object ? *choice.object : *touched.begin();
  std::erase_if(contacts, [&](const ContactRow& row) { return name_of(row) != name; });
  return name;
}

bool holds(const PassRow& pass, const ContactRow& row) {
  return row.sequence >= pass.first_sample && row.sequence <= pass.last_sample;
}

/// Leaves the contacts of one trial. @returns its pass
PassRow choose_trial(const record::SessionReader& session, const SessionChoice& choice,
                     std::vector<ContactRow>& contacts) {
  std::set<int> touched;
  std::optional<PassRow> chosen;
  for (const PassRow& pass : session.passes()) {
    if (std::none_of(contacts.begin(), contacts.end(),
                     [&](const ContactRow& row) { return holds(pass, row); })) {
      continue;
    }
    touched.insert(pass.trial);
    if (!chosen && (!choice.trial || *choice.trial == pass.trial)) {
      chosen = pass;
    }
  }
  if (!chosen) {
    throw InputError(fmt::format("{}: --trial is {}; the object was touched in the trials {}",
                                 session.path().string(), choice.trial.value_or(0),
                                 fmt::join(touched, ", ")));
  }
  std::erase_if(contacts, [&](const ContactRow& row) { return !holds(*chosen, row); });
  return *chosen;
}

/// Samples of ticks with the places of a device's tool.
std::vector<record::Sample> samples_of(const record::SessionReader& session, int device,
                                       std::uint64_t first, std::uint64_t count) {
  std::vector<record::Sample> samples =
      record::rows_of_ticks(session, record::samples_table(), first, count);
  if (device == 0) {
    return samples;
  }
  std::vector<record::Sample> result;
  auto sample = samples.begin();
  for (const record::DeviceRow& row :
       record::rows_of_ticks(session, record::table_of<record::DeviceRow>(), first, count)) {
    while (sample != samples.end() && sample->sequence < row.sequence) {
      ++sample;  // its row of the device is missing
    }
    if (row.device == device && sample != samples.end() && sample->sequence == row.sequence) {
      result.push_back(*sample);
      result.back().position = row.position;
    }
  }
  return result;
}

}  // namespace

SessionContact read_session_contact(const record::SessionReader& session,
                                    const SessionChoice& choice) {
  std::vector<ContactRow> contacts = contacts_of(session);
  SessionContact result;
  result.object = choose_object(session, choice, contacts);
  const PassRow pass = choose_trial(session, choice, contacts);
  result.trial = pass.trial;
  result.simulated = session.info().simulated;
  result.tool_radius = tool_radius_of(session, result.object);
  const int device = contacts.front().device;
  std::erase_if(contacts, [&](const ContactRow& row) { return row.device != device; });

  const auto air = static_cast<std::uint64_t>(kAir * session.info().rate);
  const std::uint64_t begin = contacts.front().sequence, end = contacts.back().sequence;
  const std::uint64_t first = std::max(pass.first_sample, begin - std::min(begin, air));
  const std::uint64_t last = std::min(pass.last_sample, end + air);
  const std::vector<record::Sample> samples = samples_of(session, device, first, last - first + 1);
  auto contact = contacts.begin();
  for (const record::Sample& sample : samples) {
    while (contact != contacts.end() && contact->sequence < sample.sequence) {
      ++contact;  // its sample is missing
    }
    const bool touching = contact != contacts.end() && contact->sequence == sample.sequence;
    const double time = kNanoseconds * static_cast<double>(sample.time_ns);
    result.recording.pose.time.push_back(time);
    result.recording.pose.position.emplace_back(touching ? contact->proxy : sample.position);
    result.recording.pose.orientation.push_back(Eigen::Quaterniond::Identity());
    result.recording.depth.push_back(touching ? contact->depth : 0.0);
    result.recording.force.time.push_back(time);
    result.recording.force.force.emplace_back(touching ? contact->force : Eigen::Vector3d::Zero());
    if (touching) {
      ++contact;
    }
  }
  return result;
}

}  // namespace haptrial::evaluation
