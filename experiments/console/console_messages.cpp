#include "experiments/console/console_messages.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

using nlohmann::json;

constexpr std::array<std::pair<Request, const char*>, 12> kNames{{
    {Request::kStart, "start"},
    {Request::kPause, "pause"},
    {Request::kRepeatTrial, "repeat"},
    {Request::kSkipTrial, "skip"},
    {Request::kAbort, "abort"},
    {Request::kEnd, "end"},
    {Request::kEmergencyStop, "emergency_stop"},
    {Request::kClear, "clear"},
    {Request::kTakeLead, "take_lead"},
    {Request::kHandOver, "hand_over"},
    {Request::kBack, "back"},
    {Request::kTakeBack, "take_back"},
}};

/// The one string that an object holds.
std::string only_string(const std::string& text, const char* key) {
  const json body = json::parse(text, nullptr, false);
  if (body.is_discarded()) {
    throw InputError("the body is not JSON");
  }
  if (!body.is_object() || body.size() != 1 || !body.contains(key) || !body[key].is_string()) {
    throw InputError(fmt::format("the body must be an object with the string \"{}\" alone", key));
  }
  return body[key].get<std::string>();
}

/// Null while nothing is asked.
json asked_json(const AskedItem& asked) {
  if (asked.number == 0) {
    return nullptr;
  }
  return {{"number", asked.number},
          {"kind", asked.kind},
          {"asks", asked.asks},
          {"consents", asked.consents},
          {"title", asked.title},
          {"text", asked.text},
          {"choices", asked.choices},
          {"low", asked.low},
          {"high", asked.high},
          {"step", asked.step},
          {"low_end", asked.low_end},
          {"high_end", asked.high_end},
          {"back", asked.back},
          {"given", asked.given},
          {"picture", asked.picture != nullptr}};
}

/// Null in a session without live figures.
json figures_json(const std::optional<record::LiveState>& state) {
  if (!state) {
    return nullptr;
  }
  json figures = json::array();
  for (const record::LiveState::Figure& figure : state->figures) {
    figures.push_back({{"name", figure.name}, {"value", figure.value}, {"alarm", figure.alarm}});
  }
  json track = json::array();
  for (const record::LiveState::TrackPoint& point : state->track) {
    track.push_back({{"level", point.level}, {"correct", point.correct}});
  }
  return {{"track", track},        {"track_name", state->track_name},
          {"trial", state->trial}, {"practice", state->practice},
          {"title", state->title}, {"figures", figures}};
}

json channels_json(const std::vector<ChannelStatus>& channels) {
  json all = json::array();
  for (const ChannelStatus& channel : channels) {
    json values = json::array();
    for (const ChannelStatus::Value& value : channel.values) {
      values.push_back({{"name", value.name}, {"value", value.value}, {"unit", value.unit}});
    }
    all.push_back({{"name", channel.name}, {"live", channel.live}, {"values", values}});
  }
  return all;
}

/// Null in a session without a partner.
json partner_json(const std::optional<record::PartnerState>& partner) {
  if (!partner) {
    return nullptr;
  }
  const record::PartnerState& p = *partner;
  return {{"heard", p.heard},
          {"linked", p.linked},
          {"coupled", p.coupled},
          {"claims", p.claims},
          {"other_claims", p.other_claims},
          {"over", p.over},
          {"silence", p.silence},
          {"lead", p.lead},
          {"round_trip", p.round_trip},
          {"jitter", p.jitter},
          {"loss", p.loss},
          {"losses", p.losses},
          {"energy", p.energy}};
}

}  // namespace

const char* name_of(Request request) noexcept {
  for (const auto& [each, name] : kNames) {
    if (each == request) {
      return name;
    }
  }
  return "";
}

Request parse_request(const std::string& text) {
  const std::string wanted = only_string(text, "request");
  std::string allowed;
  for (const auto& [request, name] : kNames) {
    if (wanted == name) {
      return request;
    }
    allowed += allowed.empty() ? name : fmt::format(", {}", name);
  }
  throw InputError(
      fmt::format("the request '{}' is not known; allowed: {}", wanted.substr(0, 40), allowed));
}

ConsoleNote parse_note(const std::string& text) {
  constexpr std::size_t kLongest = 2000;
  const json body = json::parse(text, nullptr, false);
  const bool marks = body.is_object() && body.size() == 2 && body.contains("text") &&
                     body["text"].is_string() && body.contains("bad_trial") &&
                     body["bad_trial"].is_boolean();
  const std::string note = marks ? body["text"].get<std::string>() : only_string(text, "text");
  if (note.find_first_not_of(" \t\r\n") == std::string::npos || note.size() > kLongest) {
    throw InputError(fmt::format("the note has {} bytes; allowed: 1 to {}, not all of them blank",
                                 note.size(), kLongest));
  }
  if (note.find('\0') != std::string::npos) {
    throw InputError("the note holds a zero byte");
  }
  return {note, marks && body["bad_trial"].get<bool>()};
}

std::pair<int, std::string> parse_answer(const std::string& text) {
  const json body = json::parse(text, nullptr, false);
  const bool good = !body.is_discarded() && body.is_object() && body.size() == 2 &&
                    body.contains("number") && body["number"].is_number_integer() &&
                    body.contains("text") && body["text"].is_string();
  if (!good) {
    throw InputError(
        "the body must be an object with the integer \"number\" and the string \"text\"");
  }
  const auto number = body["number"].get<std::int64_t>();
  constexpr std::int64_t kMost = 1000000;
  const auto answer = body["text"].get<std::string>();
  constexpr std::size_t kLongest = 1000;
  if (number < 1 || number > kMost || answer.size() > kLongest ||
      answer.find('\0') != std::string::npos) {
    throw InputError(
        fmt::format("allowed: the number of a question from 1, and an answer of at most {} bytes "
                    "without zero bytes",
                    kLongest));
  }
  return {static_cast<int>(number), answer};
}

std::string status_json(const SessionStatus& s, std::uint64_t refused) {
  const json out{
      {"subject", s.subject},
      {"state", s.state},
      {"screen", s.screen},
      {"trial", s.trial},
      {"practice", s.practice},
      {"trials", s.trials},
      {"trials_defined", s.trials_defined},
      {"block", s.block},
      {"blocks", s.blocks},
      {"condition", s.condition},
      {"phase", s.phase},
      {"stage", s.stage},
      {"break_left", s.break_left},
      {"target_force", s.target_force},
      {"applied_force", s.applied_force},
      {"force_on_hand", s.force_on_hand},
      {"force_limit", s.force_limit},
      {"position", {s.position.x(), s.position.y(), s.position.z()}},
      {"device", s.device},
      {"fault", s.fault},
      {"simulated", s.simulated},
      {"pilot", s.pilot},
      {"window", s.window},
      {"rate", s.rate},
      {"rate_measured", s.rate_measured},
      {"ticks", s.ticks},
      {"overruns", s.overruns},
      {"dropped", s.dropped},
      {"lateness_median_us", s.lateness_median_us},
      {"lateness_99_us", s.lateness_99_us},
      {"lateness_worst_us", s.lateness_worst_us},
      {"aborted_passes", s.aborted_passes},
      {"aborts", s.aborts},
      {"can_take_back", s.can_take_back},
      {"elapsed", s.elapsed},
      {"left", s.left < 0.0 ? json(nullptr) : json(s.left)},
      {"refused", refused},
      {"notices", s.notices},
      {"figures", figures_json(s.figures)},
      {"partner", partner_json(s.partner)},
      {"channels", channels_json(s.channels)},
      {"asked", asked_json(s.asked)},
      {"has_target", s.has_target},
  };
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace haptrial::experiments
