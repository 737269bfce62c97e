#include "core/record/hdf5/session_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <type_traits>

namespace haptrial::record {
namespace {

/// Whether an attribute is not in files of the first schema version; later ones are read from
/// /attributes, whose absent rows leave a field as it is by default.
bool is_new(std::string_view name) {
  return name.starts_with("participant_") || name == "pilot" || name == "session";
}

/// Calls visit(name, field) for every field, in the order of the file.
template <typename Info, typename Visit>
void each_field(Info& info, Visit visit) {
  visit("program_version", info.program_version);
  visit("program_commit", info.program_commit);
  visit("definition", info.definition);
  visit("definition_name", info.definition_name);
  visit("subject", info.subject);
  visit("seed", info.seed);
  visit("device", info.device);
  visit("device_max_force", info.device_max_force);
  visit("device_workspace_radius", info.device_workspace_radius);
  visit("clock", info.clock);
  visit("rate", info.rate);
  visit("start_utc", info.start_utc);
  visit("simulated", info.simulated);
  visit("pilot", info.pilot);
  visit("session", info.session);
  visit("participant_number", info.participant_number);
  visit("participant_identifier", info.participant.identifier);
  visit("participant_handedness", info.participant.handedness);
  visit("participant_age_band", info.participant.age_band);
  visit("participant_sex", info.participant.sex);
  visit("participant_consent_confirmed", info.participant.consent_confirmed);
  visit("participant_notes", info.participant.notes);
}

struct Put {
  const h5::Id& file;
  void operator()(const char* name, const std::string& value) const { h5::put(file, name, value); }
  void operator()(const char* name, std::uint64_t value) const { h5::put(file, name, value); }
  void operator()(const char* name, double value) const { h5::put(file, name, value); }
  void operator()(const char* name, bool value) const {
    h5::put(file, name, std::uint64_t{value ? 1u : 0u});
  }
};

struct Get {
  const h5::Id& file;
  std::int64_t version;
  template <typename T>
  void operator()(const char* name, T& value) const {
    if (version < 2 && is_new(name)) {
      return;
    }
    const std::string_view later[] = {"session", "participant_number"};  // than version 2
    if (std::ranges::find(later, name) != std::end(later) && !h5::has_attribute(file, name)) {
      return;
    }
    if constexpr (std::is_same_v<T, std::string>) {
      value = h5::get_text(file, name);
    } else if constexpr (std::is_same_v<T, double>) {
      value = h5::get_f64(file, name);
    } else {
      value = static_cast<T>(h5::get_u64(file, name));
    }
  }
};

template <typename T>
std::string text_of(const T& value) {
  if constexpr (std::is_same_v<T, bool>) {
    return value ? "1" : "0";
  } else {
    return fmt::format("{}", value);
  }
}

template <typename T>
void parse(const std::string& text, T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    value = text;
  } else if constexpr (std::is_same_v<T, bool>) {
    value = text == "1";
  } else {
    std::from_chars(text.data(), text.data() + text.size(), value);
  }
}

}  // namespace

std::optional<std::string> text_with_nul(const SessionInfo& info) {
  std::optional<std::string> found;
  each_field(info, [&]<typename T>(const char* name, const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
      if (!found && value.find('\0') != std::string::npos) {
        found = name;
      }
    }
  });
  return found;
}

void put_info(const h5::Id& file, const SessionInfo& info) {
  h5::put(file, "schema_version", kSchemaVersion);
  each_field(info, Put{file});
}

std::int64_t get_version(const h5::Id& file) {
  const std::int64_t version = h5::get_i64(file, "schema_version");
  if (version < 1 || version > kSchemaVersion) {
    throw h5::Error(fmt::format("schema version {} instead of 1 to {}", version, kSchemaVersion));
  }
  return version;
}

SessionInfo get_info(const h5::Id& file) {
  SessionInfo info;
  each_field(info, Get{file, get_version(file)});
  return info;
}

std::vector<EventRow> info_rows(const SessionInfo& info) {
  std::vector<EventRow> rows;
  each_field(info, [&](const char* name, const auto& value) {
    rows.push_back({0, name, text_of(value)});
  });
  return rows;
}

SessionInfo info_of(const std::vector<EventRow>& rows) {
  SessionInfo info;
  each_field(info, [&](const char* name, auto& value) {
    for (const EventRow& row : rows) {
      if (row.kind == name) {
        parse(row.text, value);
      }
    }
  });
  return info;
}

}  // namespace haptrial::record
