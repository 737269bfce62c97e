#include "springs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/definition/schema.h"
#include "core/base/random.h"
#include "core/psychometric/procedure/staircase.h"
#include "core/record/read/session_reader.h"
#include "core/record/rows/answer_rows.h"
#include "experiments/preview/preview_page.h"
#include "presser.h"
#include "protocols/definition/definition.h"
#include "protocols/definition/row_figures.h"
#include "protocols/interface/drawing.h"
#include "protocols/interface/session_file.h"
#include "spring_page.h"
#include "spring_pass.h"

using namespace haptrial;
using namespace haptrial::protocols;

// ---- what its definition states

namespace {

const Schema<SpringsDefinition>& springs_schema() {
  using D = SpringsDefinition;
  static const auto schema =
      Schema<D>()
          .number("standard", &D::standard, {50.0, 1000.0}, "N/m",
                  "Stiffness of the spring that others are compared with")
          .required()
          .number("difference", &D::difference, {1.0, 500.0}, "N/m",
                  "Stiffness by which the other spring exceeds the standard in the first trial")
          .required()
          .number("factor", &D::factor, {1.01, 4.0}, "1",
                  "Factor by which an answer divides or multiplies the difference")
          .required()
          .number("interval", &D::interval, {0.2, 10.0}, "s", "Time for which each spring is felt")
          .required();
  return schema;
}

std::unique_ptr<Definition> read_springs(Table& root, std::string_view file_name) {
  auto d = std::make_unique<SpringsDefinition>();
  read_common(root, file_name, *d);
  Table design = root.table("design");
  d->design.participants = static_cast<int>(design.integer("participants", 1, 1000));
  d->design.trials = static_cast<int>(design.integer("trials", 1, 1000));
  d->design.break_after = 0;
  Table table = root.table("springs");
  springs_schema().read(table, *d);
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

template <>
const record::Table<DepthRow>& record::table_of<DepthRow>() {
  using T = record::Table<DepthRow>;
  static const T table(
      {"depths", "how deep a spring is pressed", 1024, record::RowsOf::kTick, {"sequence"}},
      {T::column("sequence", &DepthRow::sequence, "1", "tick number, as in /samples"),
       T::column("depth", &DepthRow::depth, "m", "below the springs' rest")});
  return table;
}

namespace {

// ---- what the participant sees

render::TextPage page_of(const stimulus::Shown& shown) {
  const SpringView* view = shown.as<SpringView>();
  render::TextPage page;
  if (view != nullptr && view->asked) {
    page.title = "Which was stiffer?";
    page.body = "Left button: the first. Right button: the second.";
  } else if (view != nullptr && view->interval > 0) {
    page.title = "Spring " + std::to_string(view->interval);
  }
  return page;
}

// ---- its trials: two right answers make the next difference smaller, a wrong one larger

psychometric::StaircaseParameters staircase_of(const SpringsDefinition& d) {
  psychometric::StaircaseParameters p;
  p.axis = {psychometric::Scale::kNaturalLog, 0.0, "N/m"};
  p.start = d.difference;
  p.low = 1.0;
  p.high = 1000.0;
  p.steps = {{std::log(d.factor), std::log(d.factor)}};
  p.stop_trials = d.design.trials;
  return p;
}

class SpringTrials final : public Trials {
 public:
  SpringTrials(const SpringsDefinition& d, const SessionPlace& place)
      : d_(d),
        place_(place),
        page_(page_of<SpringPage>(place.auxiliary_pages)),
        staircase_(staircase_of(d)) {}

  Extent extent(int most) const override {
    const int trials = most > 0 ? std::min(most, d_.design.trials) : d_.design.trials;
    return {trials, 0, trials};
  }
  std::optional<PlannedTrial> next(const Outcome* last) override {
    if (last != nullptr && last->end == TrialEnd::kCompleted && !last->responses.empty()) {
      staircase_.report(last->responses.back().correct, staircase_.next());
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
    return {&record::table_of<SpringRow>(), &record::table_of<DepthRow>(),
            &record::responses_table()};
  }
  TickLog* tick_log() override { return &depths_; }
  void empty_logs(SessionFile& file) override {
    depths_.rows.flush([&file](std::span<const DepthRow> rows) { file.add(rows); });
  }
  std::uint64_t dropped() const override { return depths_.rows.dropped(); }
  std::unique_ptr<Rig> virtual_rig() const override {
    return std::make_unique<Presser>(d_, place_.session_seed);
  }
  MakeDrawing drawing() override { return text_drawing(page_of); }
  Pass& make_pass(PlannedTrial& trial, const record::Phase&) override {
    RandomStream random(place_.session_seed, "order " + std::to_string(trial.trial));
    stiffer_ = 1 + static_cast<int>(random.below(2));
    row_ = {0, staircase_.next().front(), {d_.standard, d_.standard}};
    row_.stiffness[static_cast<std::size_t>(stiffer_ - 1)] += row_.difference;
    double interval = d_.interval;
    if (page_) {
      page_->show(trial.trial, row_.difference);
      interval = page_->interval().value_or(interval);
    }
    pass_ = std::make_unique<SpringPass>(trial.trial, row_.stiffness, interval);
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
  std::string why_aborted() const override { return "no button was pressed"; }

 private:
  const SpringsDefinition& d_;
  const SessionPlace& place_;
  std::shared_ptr<SpringPage> page_;  // null: nobody assists
  psychometric::Staircase staircase_;
  DepthLog depths_;
  int trial_{0};
  int stiffer_{1};
  SpringRow row_;
  std::unique_ptr<SpringPass> pass_;
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
  record::TableList tables() const override {
    return {&record::table_of<SpringRow>(), &record::table_of<DepthRow>()};
  }
  AuxiliaryPages auxiliary_pages(const Definition&) const override {
    return {std::make_shared<SpringPage>()};
  }
  std::unique_ptr<Trials> trials(const Definition& d, const SessionPlace& place) const override {
    return std::make_unique<SpringTrials>(dynamic_cast<const SpringsDefinition&>(d), place);
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
    return std::make_unique<RowFigures<SpringRow>>([](const SpringRow& row) {
      const std::string value = std::to_string(std::lround(row.difference)) + " N/m";
      return std::vector<record::LiveState::Figure>{{"Difference", value}};
    });
  }
  void add_preview(const Definition&, const experiments::PreviewRequest&,
                   experiments::Preview& preview) const override {
    preview.document.heading("What is felt");
    preview.document.paragraph("Two springs, one after the other, of which one is stiffer.");
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
