#include "experiments/runner/session_markers.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::experiments {
namespace {

using markers::TimedOnset;
using record::MarkerOf;
using record::MarkerOutput;
using record::MarkerRow;

// Limit of waiting for onsets on their way. The sending thread never waits for its line: only a
// machine that gives it no time keeps it. A screen or a card may have stopped.
constexpr std::chrono::seconds kLongestForThread{2};
constexpr std::chrono::milliseconds kLongestForShown{100};

}  // namespace

SessionMarkers::SessionMarkers(const SessionRequest& request, markers::OnsetLog& log,
                               stream::LslOutlet* outlet, std::function<std::int64_t()> now)
    : definition_(*request.definition),
      real_(request.clock == realtime::ClockKind::kReal),
      speech_(protocols::speech_of(definition_)),
      log_(log),
      now_(std::move(now)),
      meanings_(definition_.marker_meanings()) {
  if (used() && real_) {
    open_outputs(request, outlet);
  }
}

/// Masking noise fades before the card is let go.
SessionMarkers::~SessionMarkers() {
  thread_.reset();
  if (player_ && definition_.sounds() != nullptr && definition_.sounds()->masking) {
    constexpr double kLongestFade = 2.0;  // [s]
    player_->mask(false);
    const double fade = std::min(kLongestFade, definition_.sounds()->masking->fade);
    std::this_thread::sleep_for(std::chrono::duration<double>(fade + 0.03));
  }
}

void SessionMarkers::open_outputs(const SessionRequest& request, stream::LslOutlet* outlet) {
  const markers::MarkerOptions& options = definition_.markers;
  if (!options.serial.empty()) {
    line_ = std::make_unique<markers::SerialLine>(options.serial, options.baud);
  }
  if (definition_.sounds() != nullptr || speech_.spoken) {
    open_sound(request);
  }
  if (!options.neon.empty()) {
    neon_ = std::make_unique<markers::NeonEvents>(options.neon, now_);
  }
  markers::MarkerThread::MarkerOutputs outputs;
  outputs.serial = line_.get();
  outputs.other = [this](const TimedOnset& onset) { hear(onset); };
  streams_ = outlet != nullptr;
  if (streams_) {
    outputs.stream = [this, outlet](const TimedOnset& onset) { return stream(*outlet, onset); };
  }
  thread_ =
      std::make_unique<markers::MarkerThread>(log_, options, meanings_, std::move(outputs), now_);
}

/// A session goes on without its sounds, and says so; it does not begin without its speech or its
/// stimuli.
void SessionMarkers::open_sound(const SessionRequest& request) {
  const sound::CueSet set =
      definition_.sounds() != nullptr ? *definition_.sounds() : sound::CueSet{{}, {}, speech_.card};
  if (set.masking) {
    for (const markers::MarkerMeaning& meaning : meanings_) {
      if (meaning.what == MarkerOf::kStage && !set.masking->stages.empty()) {
        masked_.push_back(std::ranges::find(set.masking->stages, meaning.name) !=
                          set.masking->stages.end());
      }
    }
  }
  try {
    player_ = std::make_unique<sound::CuePlayer>(
        set, derived_seed(request.seed, "participant " + request.subject), now_);
    player_->mask(set.masking && masked_.empty());
  } catch (const RunError& error) {
    if (speech_.spoken || set.has_stimuli()) {
      throw InputError(fmt::format(
          "{}; {} one", error.what(),
          speech_.spoken ? "display.spoken needs" : "vibrations, and sounds that vary, need"));
    }
    notice_ = fmt::format("{}; the session goes on without its sounds", error.what());
  }
}

std::string SessionMarkers::sound_state() const {
  if (definition_.sounds() == nullptr) {
    return "";
  }
  return player_ ? fmt::format("played on '{}'", definition_.sounds()->device)
         : real_ ? "not played: " + notice_
                 : "not played: the session is simulated";
}

void SessionMarkers::prepare(const std::vector<sound::Cue>& cues) {
  if (player_ && !cues.empty()) {
    player_->take_varied(cues);
  }
}

void SessionMarkers::begin_pass(std::int32_t row, std::int32_t trial) {
  const std::lock_guard lock(mutex_);
  trials_[row] = trial;
}

/// The sending thread.
void SessionMarkers::hear(const TimedOnset& onset) {
  if (player_) {
    const bool stage = !onset.over && onset.onset.what == MarkerOf::kStage;
    if (onset.over || stage) {
      player_->still();  // a vibration ends with its stage, however the stage ends
    }
    if (!onset.over && onset.onset.sound >= 0) {
      player_->start(static_cast<std::size_t>(onset.onset.sound), onset.number);
    }
    if (!masked_.empty() && (onset.over || stage)) {
      player_->mask(stage && masked_[static_cast<std::size_t>(onset.onset.index)]);
    }
  }
  tell_neon(onset);
  const std::lock_guard lock(mutex_);
  heard_.push_back(onset);
}

/// The sending thread.
void SessionMarkers::tell_neon(const TimedOnset& onset) {
  if (neon_ && !onset.over) {
    const MarkerRow row = row_of(onset);
    const std::string what = record::name_of(row.what);
    neon_->send(onset, row.name == what ? fmt::format("{} {}", what, row.trial)
                                        : fmt::format("{} {}", what, row.name));
  }
}

/// The sending thread.
bool SessionMarkers::stream(stream::LslOutlet& outlet, const TimedOnset& onset) const {
  const MarkerRow row = row_of(onset);
  return outlet.mark(
      fmt::format("onset: what={} name={} code={} trial={} interval={} pass={}",
                  record::name_of(row.what), row.name, row.code, row.trial, row.interval, row.pass),
      onset.time_ns);
}

MarkerRow SessionMarkers::row_of(const TimedOnset& onset) const {
  MarkerRow row;
  row.pass = onset.pass;
  {
    const std::lock_guard lock(mutex_);
    const auto trial = trials_.find(onset.pass);
    row.trial = trial == trials_.end() ? 0 : trial->second;
  }
  row.interval = onset.onset.interval;
  row.what = onset.onset.what;
  if (const markers::MarkerMeaning* meaning = meaning_of(meanings_, onset.onset)) {
    row.name = meaning->name.substr(0, record::kMarkerNameBytes);
    row.code = meaning->code;
  }
  row.sequence = onset.sequence;
  row.time_ns = onset.time_ns;
  return row;
}

void SessionMarkers::add(const TimedOnset& onset, MarkerOutput way, std::int64_t written_ns,
                         std::int64_t frame) {
  MarkerRow row = row_of(onset);
  row.way = way;
  row.frame = frame;
  if (written_ns >= 0) {
    row.written = 1e-9 * static_cast<double>(written_ns);
    row.latency = 1e-9 * static_cast<double>(written_ns - onset.time_ns);
  }
  latencies_.add(std::span(&row, 1));
  rows_.push_back(std::move(row));
}

/// Takes in an onset with the outputs that it waits for; one that goes nowhere has a row all the
/// same.
void SessionMarkers::take_in(const TimedOnset& onset) {
  if (onset.over) {
    return;
  }
  const auto& send = definition_.markers.send;
  bool goes =
      streams_ || neon_ || (line_ && std::ranges::find(send, onset.onset.what) != send.end());
  if (flashes_) {
    unseen_.push_back(onset);
    goes = true;
  }
  if (onset.onset.sound >= 0 && real_) {
    if (player_) {
      unheard_[onset.number] = onset;
    } else {
      add(onset, MarkerOutput::kSound, -1);
    }
    goes = true;
  }
  if (!goes) {
    add(onset, MarkerOutput::kNone, -1);
  }
}

void SessionMarkers::gather() {
  if (!thread_) {
    log_.take([this](const TimedOnset& onset) { take_in(onset); });
    return;
  }
  std::vector<TimedOnset> heard;
  {
    const std::lock_guard lock(mutex_);
    heard.swap(heard_);
  }
  std::ranges::for_each(heard, [this](const TimedOnset& onset) { take_in(onset); });
  for (const markers::SentOnset& sent : thread_->take_sent()) {
    add(sent.onset, sent.way, sent.written_ns);
  }
  for (const markers::NeonEvent& sent :
       neon_ ? neon_->take_sent() : std::vector<markers::NeonEvent>{}) {
    add(sent.onset, MarkerOutput::kNeon, sent.taken_ns);
  }
  for (const Flash& flash : flashes_ ? flashes_() : std::vector<Flash>{}) {
    const auto shown = [&](const TimedOnset& onset) { return onset.number <= flash.onsets; };
    for (const TimedOnset& onset : unseen_) {
      if (shown(onset)) {
        add(onset, MarkerOutput::kScreen, flash.time_ns, flash.frame);
      }
    }
    std::erase_if(unseen_, shown);
  }
  for (const sound::StartedCue& cue :
       player_ ? player_->take_started() : std::vector<sound::StartedCue>{}) {
    if (const auto found = unheard_.find(cue.ticket); found != unheard_.end()) {
      add(found->second, MarkerOutput::kSound, cue.handed_ns);
      unheard_.erase(found);
    }
  }
}

bool SessionMarkers::all_sent() const {
  return (!thread_ || thread_->wait_until_sent(std::chrono::milliseconds(0))) &&
         (!neon_ || neon_->all_sent());
}

bool SessionMarkers::all_shown() const { return unseen_.empty() && unheard_.empty(); }

/// The screen or the card has stopped.
void SessionMarkers::give_up_waiting() {
  for (const TimedOnset& onset : unseen_) {
    add(onset, MarkerOutput::kScreen, -1);
  }
  for (const auto& [number, onset] : unheard_) {
    add(onset, MarkerOutput::kSound, -1);
  }
  unseen_.clear();
  unheard_.clear();
}

std::vector<MarkerRow> SessionMarkers::take_rows(bool last) {
  if (!used()) {
    return {};
  }
  const auto now = &std::chrono::steady_clock::now;
  const auto begin = now();
  gather();
  while ((!all_sent() && now() < begin + kLongestForThread) ||
         (!all_shown() && now() < begin + kLongestForShown)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    gather();
  }
  if (last && neon_) {
    neon_->give_up();
  }
  gather();  // what came since all was sent
  if (last) {
    give_up_waiting();
  }
  std::vector<MarkerRow> rows = std::exchange(rows_, {});
  std::ranges::stable_sort(rows, [](const MarkerRow& a, const MarkerRow& b) {
    return std::pair(a.pass, a.sequence) < std::pair(b.pass, b.sequence);
  });
  return rows;
}

bool SessionMarkers::lost_stimuli() const {
  return player_ && player_->lost() && definition_.sounds() != nullptr &&
         definition_.sounds()->has_stimuli();
}

std::vector<std::string> SessionMarkers::troubles() const {
  std::vector<std::string> all;
  for (std::string trouble :
       {thread_ ? thread_->trouble() : std::string(), player_ ? player_->trouble() : std::string(),
        neon_ ? neon_->trouble() : std::string()}) {
    if (!trouble.empty()) {
      all.push_back(std::move(trouble));
    }
  }
  return all;
}

std::vector<std::string> SessionMarkers::latencies() const {
  std::vector<std::string> lines;
  for (const markers::MarkerTimes& times : latencies_.times()) {
    lines.push_back(sentence_of(times));
  }
  return lines;
}

}  // namespace haptrial::experiments
