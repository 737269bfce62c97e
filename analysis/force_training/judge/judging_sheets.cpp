#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "analysis/document/figure_gnuplot.h"
#include "analysis/document/palette.h"
#include "analysis/files/csv.h"
#include "analysis/files/sha256.h"
#include "analysis/force_training/judge/judged_curves.h"
#include "core/base/error.h"
#include "core/base/random.h"

namespace haptrial::analysis {
namespace {

constexpr const char* kHow =
    "Each picture has the force that was presented (line) and the force that was recalled "
    "(dashes). "
    "Judge how well it was recalled, by yourself and in any order, with a whole number from 1 (not "
    "at all) to 7 (perfectly), and write it beside the curve's number into your own copy of "
    "judgements.csv. Save that copy under your name. Some curves come twice.";

int number_of_sheet(std::size_t place, const SheetOptions& options) {
  return static_cast<int>(place) / options.each + 1;
}

/// The key's row of a curve, without its sheet.
std::string key_row(std::size_t place, const JudgedRecall& recall, int repeats) {
  const RecallScore& score = recall.detail.score;
  return fmt::format("{},{},{},{},{},{},{},{}\n", place + 1, recall.session, recall.subject,
                     recall.trial, repeats, score.alignment_cost, score.rms_force, score.rms_slope);
}

/// Every fifth sample draws a curve as well as all of them.
Series curve_of(const char* label, const RecallDetail& recall, const std::vector<double>& forces,
                const Look& look) {
  constexpr std::size_t kEvery = 5;
  Series series{label, Mark::kLine, look};
  const double step = recall.time.duration / static_cast<double>(forces.size() - 1);
  for (std::size_t i = 0; i < forces.size(); i += kEvery) {
    series.x.push_back(static_cast<double>(i) * step);
    series.y.push_back(forces[i]);
  }
  return series;
}

Figure figure_of(const JudgedRecall& recall, std::size_t place, bool simulated) {
  Figure figure;
  figure.name = fmt::format("curve-{}", place + 1);
  figure.title = fmt::format("Curve {}", place + 1);
  figure.x_label = "Time (s)";
  figure.y_label = "Force (N)";
  figure.height = 0.35;
  figure.simulated = simulated;
  figure.series = {curve_of("presented", recall.detail, recall.detail.target,
                            {palette::kBlue, palette::kSolid, 0, 2.5}),
                   curve_of("recalled", recall.detail, recall.detail.applied,
                            {palette::kOrange, palette::kLong, 0, 2.5})};
  figure.alt = "Presented and recalled force over time.";
  return figure;
}

/// The first place at which each recall stands.
std::vector<int> repeats_of(const std::vector<JudgedRecall>& recalls) {
  std::map<std::pair<std::string, int>, int> first;
  std::vector<int> repeats;
  for (std::size_t i = 0; i < recalls.size(); ++i) {
    const auto [at, fresh] =
        first.emplace(std::pair(recalls[i].session, recalls[i].trial), static_cast<int>(i) + 1);
    repeats.push_back(fresh ? 0 : at->second);
  }
  return repeats;
}

/// The rows of the key, without their sheets.
std::vector<std::string> key_rows(const std::vector<JudgedRecall>& recalls) {
  const std::vector<int> repeats = repeats_of(recalls);
  std::vector<std::string> rows;
  for (std::size_t i = 0; i < recalls.size(); ++i) {
    rows.push_back(key_row(i, recalls[i], repeats[i]));
  }
  return rows;
}

/// Names of sheets, one for each curve: a mark of the key and a number, as "s3fa9c1-2". A table of
/// judgements thereby tells which key it belongs to.
std::vector<std::string> sheets_of(const std::vector<JudgedRecall>& recalls,
                                   const SheetOptions& options) {
  constexpr std::size_t kMark = 8;
  const std::string mark =
      sha256_of(fmt::format("{}", fmt::join(key_rows(recalls), ""))).substr(0, kMark);
  std::vector<std::string> sheets;
  for (std::size_t i = 0; i < recalls.size(); ++i) {
    sheets.push_back(fmt::format("s{}-{}", mark, number_of_sheet(i, options)));
  }
  return sheets;
}

}  // namespace

std::vector<std::size_t> shuffled_recalls(std::size_t recalls, const SheetOptions& options) {
  RandomStream random(options.seed, "curves to judge");
  const auto shuffle = [&](std::vector<std::size_t>& places) {
    for (std::size_t i = places.size(); i > 1; --i) {
      std::swap(places[i - 1], places[random.below(i)]);
    }
  };
  std::vector<std::size_t> places(recalls);
  std::iota(places.begin(), places.end(), std::size_t{0});
  shuffle(places);
  places.resize(std::min(recalls, options.curves));
  const auto twice =
      static_cast<std::size_t>(std::lround(options.repeated * static_cast<double>(places.size())));
  const std::vector<std::size_t> first(places.begin(),
                                       places.begin() + static_cast<std::ptrdiff_t>(twice));
  places.insert(places.end(), first.begin(), first.end());
  shuffle(places);
  return places;
}

std::vector<std::string> judging_sheets(const std::vector<JudgedRecall>& recalls,
                                        const SheetOptions& options, bool simulated) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < recalls.size(); ++i) {
    figures.push_back(figure_of(recalls[i], i, simulated));
  }
  const std::vector<Drawing> drawings = drawn(figures);
  const std::vector<std::string> names = sheets_of(recalls, options);
  std::vector<std::string> sheets;
  for (std::size_t i = 0; i < drawings.size();) {
    Document page;
    const std::string& sheet = names[i];
    page.title = "Sheet " + sheet;
    page.simulated = simulated;
    page.paragraph(kHow);
    for (; i < drawings.size() && names[i] == sheet; ++i) {
      page.picture(drawings[i]);
    }
    sheets.push_back(to_html(page));
  }
  return sheets;
}

std::string judging_key(const std::vector<JudgedRecall>& recalls, const SheetOptions& options) {
  std::string text =
      "sheet,curve,session,participant,trial,repeats,alignment_cost,rms_force,rms_slope\n";
  const std::vector<std::string> sheets = sheets_of(recalls, options), rows = key_rows(recalls);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    text += sheets[i] + "," + rows[i];
  }
  return text;
}

std::string judging_table(const std::vector<JudgedRecall>& recalls, const SheetOptions& options) {
  std::string text = "sheet,curve,judgement\n";
  const std::vector<std::string> sheets = sheets_of(recalls, options);
  for (std::size_t i = 0; i < recalls.size(); ++i) {
    text += fmt::format("{},{},\n", sheets[i], i + 1);
  }
  return text;
}

std::vector<SheetCurve> read_judging_key(const std::filesystem::path& file) {
  const CsvTable table = CsvTable::load(file);
  const auto numbers = [&](const char* name) { return table.numbers(table.column(name)); };
  const auto curve = numbers("curve"), trial = numbers("trial"), repeats = numbers("repeats"),
             cost = numbers("alignment_cost"), force = numbers("rms_force"),
             slope = numbers("rms_slope");
  std::vector<SheetCurve> key;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto word = [&](const char* name) {
      return std::string(table.text(row, table.column(name)));
    };
    const auto whole = [&](const std::vector<double>& column) {
      return static_cast<int>(column[row]);
    };
    key.push_back({word("sheet"), whole(curve), word("session"), word("participant"), whole(trial),
                   whole(repeats), cost[row], force[row], slope[row]});
    if (key.back().first < 0 || key.back().first > static_cast<int>(row)) {
      table.refuse(row, table.column("repeats"), "0, or the number of a curve before it");
    }
  }
  return key;
}

std::vector<double> read_judgements(const std::filesystem::path& file,
                                    const std::vector<SheetCurve>& key) {
  const CsvTable table = CsvTable::load(file);
  const std::size_t sheets = table.column("sheet"), curves = table.column("curve"),
                    judgements = table.column("judgement");
  const std::vector<double> curve = table.numbers(curves), judged = table.numbers(judgements);
  std::map<int, double> known;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const auto listed =
        std::ranges::find_if(key, [&](const SheetCurve& each) { return each.curve == curve[row]; });
    if (listed != key.end() && table.text(row, sheets) != listed->sheet) {
      table.refuse(row, sheets, listed->sheet + ", as on the sheets of this study's key");
    }
    if (listed == key.end() || !known.emplace(static_cast<int>(curve[row]), judged[row]).second) {
      table.refuse(row, curves, "each number of a curve once");
    }
    const bool whole = judged[row] == std::round(judged[row]);
    if (!whole || judged[row] < kLowestJudgement || judged[row] > kHighestJudgement) {
      table.refuse(row, judgements,
                   fmt::format("whole numbers from {} to {}", kLowestJudgement, kHighestJudgement));
    }
  }
  std::vector<double> in_order;
  for (const SheetCurve& each : key) {
    const auto found = known.find(each.curve);
    if (found == known.end()) {
      throw InputError(fmt::format("{}: curve {} is missing; allowed: a judgement of every curve",
                                   file.string(), each.curve));
    }
    in_order.push_back(found->second);
  }
  return in_order;
}

}  // namespace haptrial::analysis
