#include "analysis/contact/demo_study/failure_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "analysis/document/palette.h"
#include "analysis/files/csv.h"
#include "analysis/files/delimited.h"
#include "core/base/error.h"
#include "core/contact/renderer_kinds.h"

namespace haptrial::evaluation {
namespace {

namespace palette = analysis::palette;
using contact::RendererKind;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kSphere = 5e-4;  // [m]
constexpr int kVoxels = 128;      // along the plate: cells of 0.9 mm
constexpr double kDepths[] = {0.00025, 0.0005, 0.001, 0.0015, 0.002, 0.003, 0.004, 0.006, 0.008};

/// A renderer that keeps the body which it renders.
class OwnRidge final : public contact::Renderer {
 public:
  OwnRidge(RendererKind kind, const Ridge& ridge, const contact::RendererOptions& options)
      : body_(ridge_mesh(ridge)),
        renderer_(contact::make_renderer(kind, body_.mesh, body_.surface, options)) {}
  void start(const Eigen::Vector3d& tool) noexcept override { renderer_->start(tool); }
  const contact::Contact& tick(const Eigen::Vector3d& tool, double period) noexcept override {
    return renderer_->tick(tool, period);
  }
  const contact::Operations& operations() const noexcept override {
    return renderer_->operations();
  }

 private:
  contact::FeltBody body_;
  std::unique_ptr<contact::Renderer> renderer_;
};

FailureMap map_of(RendererKind kind, double friction, double radius) {
  contact::RendererOptions options;
  options.friction = {friction, friction};
  options.radius = radius;
  options.resolution = kVoxels;
  return failure_map(
      std::string(contact::name_of(kind)), friction, radius,
      [&](const Ridge& ridge) { return std::make_unique<OwnRidge>(kind, ridge, options); });
}

analysis::Look look_of(RidgeOutcome outcome) {
  switch (outcome) {
    case RidgeOutcome::kRight:
      return {palette::kBlue, palette::kSolid, 7, 1.0, 1.0};
    case RidgeOutcome::kSticks:
      return {palette::kOrange, palette::kSolid, 5, 1.0, 1.2};
    case RidgeOutcome::kPassesUnder:
      return {palette::kBlack, palette::kSolid, 6, 1.0, 1.2};
    case RidgeOutcome::kPopsThrough:
      return {palette::kOrange, palette::kSolid, 2, 1.6, 1.2};
    case RidgeOutcome::kChatters:
      return {palette::kBlack, palette::kSolid, 9, 1.0, 1.4};
  }
  return {};
}

}  // namespace

std::vector<FailureMap::Cell> failure_cells() {
  std::vector<FailureMap::Cell> cells;
  for (int degrees = 5; degrees <= 85; degrees += 5) {
    for (const double depth : kDepths) {
      cells.push_back({degrees * kDegree, depth, {}, {}});
    }
  }
  return cells;
}

FailureMap failure_map(
    const std::string& renderer, double friction, double radius,
    const std::function<std::unique_ptr<contact::Renderer>(const Ridge&)>& make) {
  FailureMap map{renderer, friction, radius, failure_cells()};
  Ridge ridge;
  std::unique_ptr<contact::Renderer> renderer_of_it;
  for (FailureMap::Cell& cell : map.cells) {
    if (!renderer_of_it || cell.flank != ridge.flank) {
      ridge.flank = cell.flank;
      renderer_of_it = make(ridge);
    }
    const RidgeDrag drag{cell.depth, friction, radius};
    cell.result = drag_over(ridge, drag, *renderer_of_it);
    cell.law = ridge_law(ridge, drag);
  }
  return map;
}

int FailureMap::count(RidgeOutcome outcome) const {
  return static_cast<int>(std::count_if(cells.begin(), cells.end(), [&](const Cell& cell) {
    return cell.result.outcome == outcome;
  }));
}

std::vector<FailureMap> failure_maps() {
  return {
      map_of(RendererKind::kProxy, 0.0, 0.0),       map_of(RendererKind::kProxy, 0.3, 0.0),
      map_of(RendererKind::kProxy, 0.6, 0.0),       map_of(RendererKind::kProxy, 0.0, kSphere),
      map_of(RendererKind::kRuspini, 0.0, kSphere), map_of(RendererKind::kPenalty, 0.0, 0.0),
      map_of(RendererKind::kVoxel, 0.0, 0.0),       map_of(RendererKind::kDistanceField, 0.0, 0.0)};
}

std::string name_of(const FailureMap& map) {
  return map.radius > 0.0          ? map.renderer + ", sphere"
         : map.renderer == "proxy" ? fmt::format("{}, friction {}", map.renderer, map.friction)
                                   : map.renderer;
}

analysis::Figure failure_figure(const FailureMap& map) {
  analysis::Figure figure;
  std::string name = fmt::format("figure-65-{}", name_of(map));
  std::erase_if(name, [](char c) { return c == ',' || c == '.'; });
  std::replace(name.begin(), name.end(), ' ', '-');
  figure.name = name;
  figure.title = name_of(map);
  figure.x_label = "angle of the flanks (degrees)";
  figure.y_label = "depth of the tool (mm)";
  for (const RidgeOutcome outcome : kRidgeOutcomes) {
    analysis::Series series{name_of(outcome), analysis::Mark::kPoints, look_of(outcome)};
    for (const FailureMap::Cell& cell : map.cells) {
      if (cell.result.outcome == outcome) {
        series.x.push_back(cell.flank / kDegree);
        series.y.push_back(1e3 * cell.depth);
      }
    }
    if (!series.x.empty()) {
      figure.series.push_back(std::move(series));
    }
  }
  figure.x_range = {{0.0, 90.0}};
  figure.y_range = {{0.0, 8.5}};
  figure.height = 0.5;
  figure.simulated = true;
  figure.who = "TOOL";
  figure.caption = fmt::format(
      "A tool pulled straight over a ridge of 2 mm, under {}. Right: the contact "
      "climbs the ridge where Coulomb's law says, or stays where friction holds it.",
      name_of(map));
  figure.alt =
      fmt::format("{} of {} cells are right.", map.count(RidgeOutcome::kRight), map.cells.size());
  return figure;
}

std::string failure_csv(const std::vector<FailureMap>& maps) {
  std::string text =
      "renderer,friction,radius_mm,flank_deg,depth_mm,outcome,"
      "one_20th_up_mm,one_20th_up_by_law_mm,"
      "highest_mm\n";
  const auto number = [](const std::optional<double>& x) {
    return x ? fmt::format("{:.3f}", 1e3 * *x) : std::string();
  };
  for (const FailureMap& map : maps) {
    std::string renderer;
    exchange::RowText(renderer, exchange::Delimited::kCsv).add(map.renderer);
    for (const FailureMap::Cell& cell : map.cells) {
      fmt::format_to(std::back_inserter(text), "{},{},{},{:.0f},{},{},{},{},{:.3f}\n", renderer,
                     map.friction, 1e3 * map.radius, cell.flank / kDegree, 1e3 * cell.depth,
                     name_of(cell.result.outcome), number(cell.result.left_foot),
                     number(cell.law.seen()), 1e3 * cell.result.highest);
    }
  }
  return text;
}

FailureMap read_failures(const std::filesystem::path& file) {
  const auto table = analysis::CsvTable::load(file);
  const std::vector<double> flanks = table.numbers(table.column("flank_deg"));
  const std::vector<double> depths = table.numbers(table.column("depth_mm"));
  const std::size_t renderer = table.column("renderer"), outcome = table.column("outcome");
  FailureMap map{std::string(table.text(0, renderer)), 0.0, 0.0, {}};
  constexpr double kSame = 1e-6;  // [rad], [m]
  std::vector<FailureMap::Cell> missing = failure_cells();
  for (std::size_t i = 0; i < table.rows(); ++i) {
    const auto found = std::ranges::find_if(
        kRidgeOutcomes, [&](RidgeOutcome one) { return table.text(i, outcome) == name_of(one); });
    if (found == kRidgeOutcomes.end()) {
      table.refuse(i, outcome, "an outcome that a map of failures has");
    }
    const FailureMap::Cell cell{
        flanks[i] * kDegree, 1e-3 * depths[i], RidgeResult{*found, {}, 0.0}, {}};
    const auto same = [&](const FailureMap::Cell& other) {
      return std::abs(other.flank - cell.flank) < kSame &&
             std::abs(other.depth - cell.depth) < kSame;
    };
    if (std::erase_if(missing, same) == 0) {
      table.refuse(i, table.column("flank_deg"), "with depth_mm a ridge that is asked, each once");
    }
    map.cells.push_back(cell);
  }
  if (!missing.empty()) {
    throw InputError(fmt::format(
        "{}: has no row for {:.0f} degrees and {} mm; allowed: a row for each of {} ridges",
        file.string(), missing[0].flank / kDegree, 1e3 * missing[0].depth, failure_cells().size()));
  }
  return map;
}

}  // namespace haptrial::evaluation
