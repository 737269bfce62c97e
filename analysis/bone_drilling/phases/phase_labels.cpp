#include "analysis/bone_drilling/phases/phase_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/files/csv.h"
#include "analysis/files/delimited.h"
#include "core/base/error.h"

namespace haptrial::analysis::drilling {
namespace {

struct Row {
  PhaseSpan span;
  std::size_t row;  // of the table
};

/// Sorts a procedure's spans; refuses the first that overlaps the one before.
std::vector<PhaseSpan> sorted(std::vector<Row> rows, const CsvTable& table, std::size_t column) {
  std::stable_sort(rows.begin(), rows.end(),
                   [](const Row& a, const Row& b) { return a.span.start < b.span.start; });
  std::vector<PhaseSpan> spans;
  for (const Row& row : rows) {
    if (!spans.empty() && row.span.start < spans.back().end) {
      table.refuse(row.row, column, "a time at or after the end of the phase before");
    }
    spans.push_back(row.span);
  }
  return spans;
}

int number_of(const CsvTable& table, std::size_t row, std::size_t column, double value) {
  constexpr double kMostProcedures = 999'999.0;
  if (!(value >= 1.0 && value <= kMostProcedures) || value != std::floor(value)) {
    table.refuse(row, column, "a whole number from 1 to 999999");
  }
  return static_cast<int>(value);
}

}  // namespace

std::string phase_labels_csv(const PhaseLabels& labels) {
  std::string text = "session,procedure,phase,start_s,end_s\n";
  for (const auto& [key, spans] : labels) {
    for (const PhaseSpan& span : spans) {
      exchange::RowText row(text, exchange::Delimited::kCsv);
      row.add(std::string_view(key.first)).add(key.second).add(std::string_view(span.phase));
      row.add(span.start).add(span.end).end();
    }
  }
  return text;
}

PhaseLabels read_phase_labels(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file);
  const std::size_t session = table.column("session"), procedure = table.column("procedure");
  const std::size_t phase = table.column("phase"), start = table.column("start_s");
  const std::size_t end = table.column("end_s");
  const std::vector<double> numbers = table.numbers(procedure), starts = table.numbers(start),
                            ends = table.numbers(end);
  std::map<std::pair<std::string, int>, std::vector<Row>> rows;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    PhaseSpan span{std::string(table.text(row, phase)), starts[row], ends[row]};
    if (span.phase.empty()) {
      table.refuse(row, phase, "the name of a phase");
    }
    if (!(span.start >= 0.0)) {
      table.refuse(row, start, "a time of the procedure from 0 [s]");
    }
    if (!(span.end > span.start)) {
      table.refuse(row, end, "a time after the start [s]");
    }
    const int number = number_of(table, row, procedure, numbers[row]);
    rows[{std::string(table.text(row, session)), number}].push_back({std::move(span), row});
  }
  PhaseLabels labels;
  for (auto& [key, own] : rows) {
    labels[key] = sorted(std::move(own), table, start);
  }
  return labels;
}

void check_phase_labels(const PhaseLabels& labels, const ProcedureLengths& lengths,
                        const std::string& file, const std::string& study) {
  constexpr double kRounding = 1.0;  // of ends that people write down [s]
  for (const auto& [key, spans] : labels) {
    const auto length = lengths.find(key);
    if (length == lengths.end()) {
      throw InputError(fmt::format("{}: labels procedure {} of {}, which {} does not have", file,
                                   key.second, key.first, study));
    }
    if (spans.back().end > length->second + kRounding) {
      throw InputError(fmt::format(
          "{}: phase \"{}\" of procedure {} of {} ends at {:g} s, but the procedure "
          "lasts {:.1f} s; write times of the procedure in seconds",
          file, spans.back().phase, key.second, key.first, spans.back().end, length->second));
    }
  }
}

std::vector<std::string> names_in(const PhaseLabels& labels) {
  std::vector<std::vector<PhaseSpan>> procedures;
  for (const auto& [key, spans] : labels) {
    procedures.push_back(spans);
  }
  return phases_in_order(procedures);
}

std::vector<int> phases_at(std::span<const Action> actions, const std::vector<PhaseSpan>& spans,
                           const std::vector<std::string>& names, double rate) {
  std::vector<int> phases;
  for (const Action& action : actions) {
    const double middle = 0.5 * static_cast<double>(action.first + action.last + 1) / rate;
    const auto span = std::find_if(spans.begin(), spans.end(), [&](const PhaseSpan& each) {
      return each.start <= middle && middle < each.end;
    });
    const auto name =
        span == spans.end() ? names.end() : std::find(names.begin(), names.end(), span->phase);
    phases.push_back(name == names.end() ? -1 : static_cast<int>(name - names.begin()));
  }
  return phases;
}

namespace {

void hold_against(const PhaseModel& model, const PhaseCase& each, Eigen::MatrixXd& ticks) {
  const std::vector<int> found = phases_of(model, each.actions);
  for (std::size_t t = 0; t < found.size(); ++t) {
    if (each.phase[t] >= 0) {
      const Action& action = each.actions[t];
      ticks(each.phase[t], found[t]) += static_cast<double>(action.last + 1 - action.first);
    }
  }
}

}  // namespace

double PhaseAccuracy::right() const {
  const double all = ticks.sum();
  return all > 0.0 ? ticks.trace() / all : 0.0;
}

double PhaseAccuracy::chance() const {
  const double all = ticks.sum();
  return all > 0.0 ? ticks.rowwise().sum().maxCoeff() / all : 0.0;
}

double PhaseAccuracy::kappa() const {
  const double all = ticks.sum();
  if (!(all > 0.0)) {
    return 0.0;
  }
  const double expected =
      ticks.rowwise().sum().dot(ticks.colwise().sum().transpose()) / (all * all);
  return expected < 1.0 ? (right() - expected) / (1.0 - expected) : 0.0;
}

Defined<PhaseAccuracy> left_out_accuracy(std::span<const PhaseCase> cases,
                                         const std::vector<std::string>& phases) {
  std::set<std::string> people;
  for (const PhaseCase& each : cases) {
    people.insert(each.participant);
  }
  if (people.size() < 2) {
    return Undefined{"there are fewer than two participants"};
  }
  const auto count = static_cast<Eigen::Index>(phases.size());
  PhaseAccuracy accuracy{Eigen::MatrixXd::Zero(count, count)};
  for (const std::string& person : people) {
    std::vector<PhaseCase> others;
    for (const PhaseCase& each : cases) {
      if (each.participant != person) {
        others.push_back(each);
      }
    }
    const Defined<PhaseModel> model = learn_phases(others, phases);
    if (!model) {
      return Undefined{"without " + person + " " + model.because()};
    }
    for (const PhaseCase& each : cases) {
      if (each.participant == person) {
        hold_against(*model, each, accuracy.ticks);
      }
    }
  }
  return accuracy;
}

}  // namespace haptrial::analysis::drilling
