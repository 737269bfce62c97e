#include "springs.h"

#include <algorithm>
#include <mutex>
#include <numeric>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "core/base/random.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/response.h"
#include "core/render/flat/text_screen.h"
#include "core/subject/hand.h"
#include "protocols/definition/definition.h"
#include "protocols/interface/session_file.h"
#include "spring_pass.h"

using namespace haptrial;
using namespace haptrial::protocols;

// ---- what its definition states

namespace {

struct SpringsDefinition final : Definition {
  double standard{0.0};    // stiffness of the one spring [N/m]
  double difference{0.0};  // of the other, at first [N/m]
  double factor{0.0};      // of a step of the staircase
  double interval{0.0};    // [s]

  bool has_target() const override { return false; }
  std::vector<std::string> description() const override {
    return {"two springs, one after the other; a button says which was stiffer"};
  }
  double longest(int trials) const override { return trials * (2.0 * interval + 2.0); }
};

std::unique_ptr<Definition> read_springs(Table& root, std::string_view file_name) {
  auto d = std::make_unique<SpringsDefinition>();
  read_common(root, file_name, *d);
  Table design = root.table("design");
  d->design.participants = static_cast<int>(design.integer("participants", 1, 1000));
  d->design.trials = static_cast<int>(design.integer("trials", 1, 1000));
  d->design.break_after = 0;
  Table table = root.table("springs");
  d->standard = table.number("standard", {50.0, 1000.0}, "N/m");
  d->difference = table.number("difference", {1.0, 500.0}, "N/m");
  d->factor = table.number("factor", {1.01, 4.0}, "1");
  d->interval = table.number("interval", {0.2, 10.0}, "s");
  check_common(root, *d);
  return d;
}

}  // namespace

// ---- what it records

template <>
const record::Table<SpringRow>& record::table_of<SpringRow>() {
  using T = record::Table<SpringRow>;
  static const T table(
      {"springs", "the springs of each pass", 64, record::RowsOf::kPass, {"pass"}},
      {T::column("pass", &SpringRow::pass, "1", "row of /trials"),
       T::column("difference", &SpringRow::difference, "N/m", "of the staircase"),
       T::elements(std::array{"first", "second"}, &SpringRow::stiffness, "N/m", "stiffness felt")});
  return table;
}

namespace {

// ---- the virtual participant: presses with 3 N, remembers how stiff each felt, answers

class Presser final : public Rig, public stimulus::Observer {
 public:
  Presser(const SpringsDefinition& d, std::uint64_t seed)
      : hand_(d.hand, 1.0 / d.rate, Eigen::Vector3d::Zero()), device_(d.device, hand_, d.rate) {
    constexpr double kWeber = 0.08;
    for (int trial = 1; trial <= d.design.trials; ++trial) {  // the same whenever it comes
      RandomStream random(seed, "judgement " + std::to_string(trial));
      noise_.push_back(kWeber * d.standard * std::sqrt(2.0) * random.normal());
    }
  }
  device::Device& device() override { return device_; }
  stimulus::Observer* subject() override { return this; }

  void observe(const stimulus::Shown& shown, const stimulus::Forces& forces,
               double) noexcept override {
    const SpringView* view = shown.as<SpringView>();
    const int interval = view != nullptr ? view->interval : 0;
    subject::HandCommand command;
    command.press = interval > 0 ? 3.0 : 0.0;
    hand_.command(command);
    constexpr double kDeepEnough = 0.002;  // [m]
    if (interval > 0 && shown.tool.y() < -kDeepEnough) {
      felt_[interval - 1] = forces[0].y() / -shown.tool.y();
    }
    std::uint32_t button = 0;
    if (view != nullptr && view->asked) {
      const double noise = noise_[static_cast<std::size_t>(view->trial - 1)];
      button = felt_[0] + noise > felt_[1] ? 1u : 2u;
    }
    device_.hold(button, 0.0, Eigen::Quaterniond::Identity());
  }

 private:
  subject::Hand hand_;
  device::VirtualDevice device_;
  std::vector<double> noise_;
  std::array<double, 2> felt_{};
};

// ---- what the participant sees

class SpringDrawing final : public Drawing {
 public:
  SpringDrawing(const render::Gl& gl, int width, int height)
      : screen_(gl, width, height, kBlack, kWhite, kWhite) {}
  void draw(const stimulus::Shown& shown) override {
    const SpringView* view = shown.as<SpringView>();
    render::TextPage page;
    if (view != nullptr && view->asked) {
      page = {"Which was stiffer?", "Left button: the first. Right button: the second.", "", {}};
    } else if (view != nullptr && view->interval > 0) {
      page.title = "Spring " + std::to_string(view->interval);
    }
    screen_.draw(page);
  }

 private:
  static constexpr render::Colour kBlack{0.0, 0.0, 0.0, 1.0};
  static constexpr render::Colour kWhite{1.0, 1.0, 1.0, 1.0};
  render::TextScreen screen_;
};

// ---- its trials

class SpringTrials final : public Trials {
 public:
  SpringTrials(const SpringsDefinition& d, const SessionPlace& place)
      : d_(d), place_(place), difference_(d.difference) {}

  Extent extent(int most) const override {
    const int trials = most > 0 ? std::min(most, d_.design.trials) : d_.design.trials;
    return {trials, 0, trials};
  }
  std::optional<PlannedTrial> next(const Outcome* last) override {
    if (last != nullptr && last->end == TrialEnd::kCompleted && !last->responses.empty()) {
      step(last->responses.back().correct == 1);
    }
    if (++trial_ > d_.design.trials) {
      return std::nullopt;
    }
    return PlannedTrial{trial_, trial_, 1, "staircase", 0, false};
  }
  std::span<const record::Phase> phases() const override {
    static constexpr std::array kPhases{record::Phase("compare")};
    return kPhases;
  }
  record::TableList tables() const override {
    return {&record::table_of<SpringRow>(), &record::responses_table()};
  }
  std::unique_ptr<Rig> virtual_rig() const override {
    return std::make_unique<Presser>(d_, place_.session_seed);
  }
  void prepare(const PlannedTrial&, SessionFile&) override {}
  MakeDrawing drawing() override {
    return [](const render::Gl& gl, int width, int height) {
      return std::make_unique<SpringDrawing>(gl, width, height);
    };
  }
  Pass& make_pass(PlannedTrial& trial, const record::Phase&) override {
    RandomStream random(place_.session_seed, "order " + std::to_string(trial.trial));
    stiffer_ = 1 + static_cast<int>(random.below(2));
    row_ = {0, difference_, {d_.standard, d_.standard}};
    row_.stiffness[static_cast<std::size_t>(stiffer_ - 1)] += difference_;
    pass_ = std::make_unique<SpringPass>(trial.trial, row_.stiffness, d_.interval);
    return *pass_;
  }
  std::vector<record::ResponseRow> responses() override {
    if (pass_->answer() == 0) {
      return {};
    }
    record::ResponseRow row;
    row.question = "stiffer";
    row.value = pass_->answer();
    row.text = pass_->answer() == 1 ? "first" : "second";
    row.correct = pass_->answer() == stiffer_ ? 1 : 0;
    row.source = record::ResponseSource::kButton;
    row.code = pass_->answer() - 1;
    row.reaction_time = pass_->reaction_time();
    return {row};
  }
  void close_pass(SessionFile& file, std::int32_t row) override {
    row_.pass = row;
    file.add(std::span<const SpringRow>(&row_, 1));
  }
  const char* why_aborted() const override { return "no button was pressed"; }

 private:
  void step(bool right) {
    right_ = right ? right_ + 1 : 0;
    if (!right || right_ == 2) {
      difference_ *= right ? 1.0 / d_.factor : d_.factor;
      right_ = 0;
    }
  }

  const SpringsDefinition& d_;
  const SessionPlace& place_;
  double difference_;
  int right_{0};  // answers in a row
  int trial_{0};
  int stiffer_{1};
  SpringRow row_;
  std::unique_ptr<SpringPass> pass_;
};

// ---- what the experimenter sees while it runs

class SpringFigures final : public record::LiveFigures {
 public:
  void begin_pass(const record::PassRow& pass, std::int32_t) override {
    const std::lock_guard lock(mutex_);
    trial_ = pass.trial;
  }
  void rows(const record::Rows& rows) override {
    const std::lock_guard lock(mutex_);
    for (const SpringRow& row : rows.as<SpringRow>()) {
      const std::string value = std::to_string(std::lround(row.difference)) + " N/m";
      record::LiveState state;
      state.trial = trial_;
      state.title = "Comparison " + std::to_string(trial_);
      state.figures = {{"Difference", value}};
      state.line = state.title + ": " + value;
      done_.push_back(state);
    }
  }
  std::optional<record::LiveState> now() const override {
    const std::lock_guard lock(mutex_);
    return done_.empty() ? std::nullopt : std::optional(done_.back());
  }
  std::vector<record::LiveState> done() const override {
    const std::lock_guard lock(mutex_);
    return done_;
  }

 private:
  mutable std::mutex mutex_;
  int trial_{0};
  std::vector<record::LiveState> done_;
};

// ---- all of it together, with its analysis

class Springs final : public Protocol {
 public:
  std::string_view name() const override { return "springs"; }
  std::unique_ptr<Definition> read(Table& root, std::string_view file_name,
                                   const std::filesystem::path*) const override {
    return read_springs(root, file_name);
  }
  std::vector<std::pair<record::Phase, std::string>> phases() const override {
    return {{record::Phase("compare"), "two springs are felt and compared"}};
  }
  record::TableList tables() const override { return {&record::table_of<SpringRow>()}; }
  std::unique_ptr<Trials> trials(const Definition& d, const SessionPlace& place) const override {
    return std::make_unique<SpringTrials>(dynamic_cast<const SpringsDefinition&>(d), place);
  }
  void replay(const ReplayRequest& request) const override {
    throw InputError(request.file.string() + ": sessions of springs cannot be replayed");
  }
};

class SpringsStudy final : public experiments::Study {
 public:
  const Protocol& protocol() const override {
    static const Springs protocol;
    return protocol;
  }
  std::unique_ptr<record::LiveFigures> live_figures(const Definition&,
                                                    const std::filesystem::path&) const override {
    return std::make_unique<SpringFigures>();
  }
  std::vector<std::string> analyze(const experiments::AnalysisRequest& request) const override {
    std::vector<std::string> lines;
    for (const auto& file : request.files.files) {  // the second half of a staircase stands still
      const record::SessionReader reader(file);
      const auto rows = reader.rows<SpringRow>();
      const auto half = rows.begin() + static_cast<std::ptrdiff_t>(rows.size() / 2);
      const double sum = std::accumulate(half, rows.end(), 0.0, [](double total, const auto& row) {
        return total + row.difference;
      });
      lines.push_back(reader.info().subject + ": threshold " +
                      std::to_string(sum / static_cast<double>(rows.end() - half)) + " N/m");
    }
    return lines;
  }
};

}  // namespace

const experiments::Study& springs() {
  static const SpringsStudy study;
  return study;
}
