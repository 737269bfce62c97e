#include "protocols/tutoring/model_motion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/record/read/session_reader.h"
#include "core/record/read/tick_rows.h"

namespace haptrial::protocols {
namespace {

template <class Number>
bool read_number(std::string_view text, Number& number) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

std::vector<tutoring::Partner> run_of(const record::SessionReader& reader,
                                      const record::PassRow& pass) {
  std::vector<tutoring::Partner> ticks;
  for (const record::Sample& sample : record::samples_of_pass(reader, pass)) {
    if (sample.stage == record::Stage::kRun) {
      ticks.push_back({{sample.position, sample.velocity}, sample.force});
    }
  }
  return ticks;
}

}  // namespace

TutorChoice read_tutor_choice(const std::string& text) {
  TutorChoice choice;
  const std::size_t colon = text.rfind(':');
  choice.file = text.substr(0, colon);
  bool good = !choice.file.empty();
  if (colon != std::string::npos) {
    const std::string_view rest = std::string_view(text).substr(colon + 1);
    const std::size_t at = rest.find('@');
    int trial = 0;
    good = good && read_number(rest.substr(0, at), trial) && trial >= 1;
    choice.trial = trial;
    if (at != std::string_view::npos) {
      good = good && read_number(rest.substr(at + 1), choice.from) && choice.from >= 0.0 &&
             std::isfinite(choice.from);
    }
  }
  if (!good) {
    throw InputError(
        fmt::format("--tutor is '{}'; allowed: FILE, FILE:TRIAL or FILE:TRIAL@SECONDS", text));
  }
  return choice;
}

ModelMotion read_model(const TutorChoice& choice) {
  const record::SessionReader reader(choice.file);
  ModelMotion motion;
  motion.rate = reader.info().rate;
  motion.subject = reader.info().subject;
  motion.definition = reader.info().definition;
  motion.definition_name = reader.info().definition_name;
  std::set<int> known;
  for (const record::PassRow& pass : reader.passes()) {
    if (pass.status != record::PassStatus::kCompleted || pass.practice) {
      continue;
    }
    const bool wanted = !choice.trial || *choice.trial == pass.trial;
    if (wanted && motion.ticks.empty()) {
      motion.trial = pass.trial;
      motion.ticks = run_of(reader, pass);
    }
    known.insert(pass.trial);
  }
  if (motion.ticks.empty()) {
    throw InputError(
        known.empty() ? fmt::format("{}: holds no completed trial", choice.file.string())
                      : fmt::format("--tutor: {} holds no completed run of trial {}; allowed: {}",
                                    choice.file.string(), choice.trial.value_or(*known.begin()),
                                    fmt::join(known, ", ")));
  }
  if (choice.from >= motion.duration()) {
    throw InputError(
        fmt::format("--tutor: the run of trial {} is {:.1f} s long; {:g} s is not in it",
                    motion.trial, motion.duration(), choice.from));
  }
  return motion;
}

void Playback::step(double dt) noexcept {
  time_ = std::min(time_ + pace_.share() * speed_ * dt, motion_->duration());
  pace_.ask(waits_ || over() ? 0.0 : 1.0);
  pace_.step(dt);
}

tutoring::Partner Playback::now() const noexcept {
  const std::vector<tutoring::Partner>& ticks = motion_->ticks;
  const double at = std::min(time_ * motion_->rate, static_cast<double>(ticks.size() - 1));
  const auto i = static_cast<std::size_t>(at);
  const double part = at - static_cast<double>(i);
  const tutoring::Partner& a = ticks[i];
  const tutoring::Partner& b = ticks[std::min(i + 1, ticks.size() - 1)];
  tutoring::Partner now;
  now.tool.position = (1.0 - part) * a.tool.position + part * b.tool.position;
  now.tool.velocity =
      pace_.share() * speed_ * ((1.0 - part) * a.tool.velocity + part * b.tool.velocity);
  now.force = (1.0 - part) * a.force + part * b.force;
  return now;
}

}  // namespace haptrial::protocols
