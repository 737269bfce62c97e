#include "tests/analysis/statistics/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace haptrial::analysis::reference {
namespace {

std::ifstream opened(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) {
    throw std::runtime_error(file.string() + " cannot be read");
  }
  return in;
}

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) {
    result.push_back(cell);
  }
  return result;
}

std::vector<Topic>& registered() {
  static std::vector<Topic> topics;
  return topics;
}

std::string key(const std::string& procedure, const std::string& where) {
  return procedure + ", " + where;
}

}  // namespace

std::filesystem::path folder() {
  return std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "tests/analysis/statistics/reference";
}

DataSet::DataSet(const std::string& name) {
  auto in = opened(folder() / "data" / (name + ".csv"));
  std::string line;
  std::getline(in, line);
  const auto names = cells(line);
  while (std::getline(in, line)) {
    const auto row = cells(line);
    for (std::size_t i = 0; i < names.size(); ++i) {
      columns_[names[i]].push_back(row.at(i));
    }
  }
}

const std::vector<std::string>& DataSet::texts(const std::string& column) const {
  return columns_.at(column);
}

std::vector<double> DataSet::numbers(const std::string& column) const {
  std::vector<double> result;
  for (const auto& text : texts(column)) {
    result.push_back(text == "NA" ? std::numeric_limits<double>::quiet_NaN() : std::stod(text));
  }
  return result;
}

std::vector<std::vector<double>> DataSet::groups(const std::string& column,
                                                 const std::string& factor) const {
  const auto values = numbers(column);
  const auto& levels = texts(factor);
  std::map<std::string, std::vector<double>> by_level;
  for (std::size_t i = 0; i < values.size(); ++i) {
    by_level[levels[i]].push_back(values[i]);
  }
  std::vector<std::vector<double>> result;
  for (auto& [level, group] : by_level) {
    result.push_back(std::move(group));
  }
  return result;
}

std::vector<std::vector<double>> DataSet::means(const std::string& column, const std::string& rows,
                                                const std::string& columns) const {
  const auto values = numbers(column);
  const auto& row_levels = texts(rows);
  const auto& column_levels = texts(columns);
  std::map<std::string, std::map<std::string, std::vector<double>>> by_cell;
  for (std::size_t i = 0; i < values.size(); ++i) {
    by_cell[row_levels[i]][column_levels[i]].push_back(values[i]);
  }
  std::vector<std::vector<double>> result;
  for (const auto& [row_level, row] : by_cell) {
    result.emplace_back();
    for (const auto& [column_level, cell] : row) {
      const double sum = std::accumulate(cell.begin(), cell.end(), 0.0);
      result.back().push_back(sum / static_cast<double>(cell.size()));
    }
  }
  return result;
}

double relative_difference(double ours, double r) {
  if (ours == r) {
    return 0.0;
  }
  return r == 0.0 ? std::abs(ours) : std::abs(ours - r) / std::abs(r);
}

Answers::Answers(const std::filesystem::path& file) {
  auto in = opened(file);
  bool header = true;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("# ")) {
      versions_.push_back(line.substr(2));
    } else if (line.starts_with("@ ")) {  // @ procedure | call
      const auto bar = line.find(" | ");
      procedures_.push_back({line.substr(2, bar - 2), line.substr(bar + 3)});
    } else if (header) {
      header = false;
    } else {
      const auto row = cells(line);
      const auto place = key(row.at(0), key(row.at(1), row.at(2)));
      if (!values_.emplace(place, std::stod(row.at(3))).second) {
        throw std::runtime_error(file.string() + " gives two values of " + place);
      }
      used_[place] = false;
    }
  }
}

Answers::Case Answers::at(const std::string& procedure, const std::string& name) {
  return {*this, procedure, name};
}

std::vector<std::string> Answers::unused() const {
  std::vector<std::string> result;
  for (const auto& [place, used] : used_) {
    if (!used) {
      result.push_back(place);
    }
  }
  return result;
}

void Answers::note(const std::string& procedure, const std::string& where, double ours) {
  const auto row = std::find_if(procedures_.begin(), procedures_.end(),
                                [&](const auto& p) { return p.name == procedure; });
  const auto value = values_.find(key(procedure, where));
  if (row == procedures_.end() || value == values_.end()) {
    throw std::runtime_error("R gave no " + key(procedure, where));
  }
  used_[value->first] = true;
  ++row->compared;
  const double difference = relative_difference(ours, value->second);
  if (!(difference <= row->largest_difference)) {  // also where it is NaN
    row->largest_difference = difference;
    row->where = where;
  }
}

Answers::Case::Case(Answers& answers, std::string procedure, std::string name)
    : answers_(answers), procedure_(std::move(procedure)), name_(std::move(name)) {}

Answers::Case& Answers::Case::is(const std::string& quantity, double ours) {
  answers_.note(procedure_, key(name_, quantity), ours);
  return *this;
}

Answers::Case& Answers::Case::are(const std::string& quantity, const std::vector<double>& ours) {
  if (ours.size() == 1) {
    return is(quantity, ours.front());
  }
  for (std::size_t i = 0; i < ours.size(); ++i) {
    is(quantity + "." + std::to_string(i + 1), ours[i]);
  }
  return *this;
}

Topic::Topic(const std::string& topic, void (*function)(Answers&))
    : name(topic), compare(function) {
  registered().push_back(*this);
}

void PrintTo(const Topic& topic, std::ostream* out) { *out << topic.name; }

std::vector<Topic> topics() {
  auto result = registered();
  std::sort(result.begin(), result.end(),
            [](const Topic& a, const Topic& b) { return a.name < b.name; });
  return result;
}

}  // namespace haptrial::analysis::reference
