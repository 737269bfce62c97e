#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>

#include "analysis/document/figure_gnuplot.h"
#include "core/base/error.h"
#include "core/base/nearest.h"
#include "core/base/scratch_folder.h"
#include "core/bone/model/bone_model.h"
#include "core/bone/model/tidy.h"
#include "experiments/command/arguments.h"
#include "experiments/command/bone/bone_options.h"
#include "experiments/command/subcommand.h"

namespace haptrial::experiments {
namespace {

struct BoneImportOptions : BoneInput, BoneOutput, BoneBox {
  std::string segmentation;
  std::vector<std::string> structures;
  std::string mesh_axes{"auto"};
  bool largest{false};
  std::optional<double> fill;
  std::string histogram;
};

namespace fs = std::filesystem;

/// "NAME=FILE" for each. @throws InputError
std::vector<bone::MeshStructure> meshes_of(const BoneImportOptions& options) {
  std::optional<bool> ras;
  if (options.mesh_axes == "ras" || options.mesh_axes == "lps") {
    ras = options.mesh_axes == "ras";
  } else if (options.mesh_axes != "auto") {
    throw InputError(
        not_allowed("--mesh-axes", fmt::format("'{}'", options.mesh_axes), {"auto", "lps", "ras"}));
  }
  std::vector<bone::MeshStructure> meshes;
  for (const std::string& words : options.structures) {
    const std::size_t sign = words.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == words.size()) {
      throw InputError(
          fmt::format("--structure is '{}'; allowed: NAME=FILE, as in 'facial "
                      "nerve=nerve.stl'",
                      words));
    }
    meshes.push_back({words.substr(0, sign), words.substr(sign + 1), ras});
  }
  return meshes;
}

void check_fill(const BoneImportOptions& options) {
  constexpr double kMost = 1e6;  // [mm3]
  if (options.fill && !(*options.fill > 0.0 && *options.fill <= kMost)) {
    throw InputError(
        fmt::format("--fill is {}; allowed: above 0, to {} [mm3]", *options.fill, kMost));
  }
}

analysis::Series upright_line(const std::string& label, double x, double top, const char* color,
                              const char* dash) {
  analysis::Series series;
  series.label = label;
  series.mark = analysis::Mark::kSegments;
  series.look = {.color = color, .dash = dash, .width = 2.0};
  series.x = {x};
  series.y = {0.0};
  series.x2 = {x};
  series.y2 = {top};
  return series;
}

analysis::Figure histogram_figure(const bone::GreyFindings& findings, const std::string& name) {
  const bone::GreyHistogram& histogram = findings.histogram;
  analysis::Figure figure;
  figure.name = "histogram";
  figure.title = name;
  figure.x_label = "value";
  figure.y_label = "log10(voxels + 1)";
  analysis::Series counts;
  counts.label = "voxels";
  counts.look = {.color = "#1f6f8b", .width = 1.5};
  double top = 1.0;
  for (std::size_t bin = 0; bin < bone::GreyHistogram::kBins; ++bin) {
    const double height = std::log10(histogram.counts[bin] + 1.0);
    top = std::max(top, height);
    for (const double side : {0.0, 1.0}) {  // steps
      counts.x.push_back(histogram.value_of(static_cast<double>(bin) + side));
      counts.y.push_back(height);
    }
  }
  figure.series.push_back(std::move(counts));
  figure.series.push_back(upright_line(fmt::format("suggested: {:.6g}", findings.suggested),
                                       findings.suggested, top, "#c8553d", "(6,3)"));
  if (findings.used) {
    figure.series.push_back(
        upright_line(fmt::format("bone from {:.6g} on", findings.used->threshold),
                     findings.used->threshold, top, "#000000", "solid"));
    figure.series.push_back(upright_line(fmt::format("dense at {:.6g}", findings.used->dense),
                                         findings.used->dense, top, "#6b6b6b", "(2,3)"));
  }
  figure.height = 0.45;
  return figure;
}

/// Draws NAME.svg or NAME.png elsewhere and brings the one that is asked for.
void draw_histogram(const BoneImportOptions& options, const bone::GreyFindings& findings) {
  const ScratchFolder folder("histogram");
  analysis::draw_figures({histogram_figure(findings, fs::path(options.in).filename().string())},
                         folder.path());
  try {
    const fs::path ending = fs::path(options.histogram).extension();
    fs::copy_file(folder.path() / ("histogram" + ending.string()), options.histogram,
                  fs::copy_options::overwrite_existing);
  } catch (const fs::filesystem_error& error) {
    throw InputError(
        fmt::format("{}: cannot be written ({}); choose a folder with write permission",
                    options.histogram, error.code().message()));
  }
  fmt::print("histogram   {}: a threshold of {:.6g} is suggested\n", options.histogram,
             findings.suggested);
}

void tidy(const BoneImportOptions& options, bone::BoneModel& model) {
  if (options.fill) {
    const double voxel = 1e9 * std::pow(model.grid.spacing, 3);
    const auto most = static_cast<std::size_t>(*options.fill / voxel);
    const bone::TidyResult filled = bone::fill_holes(model, most);
    fmt::print("filled      {} holes: {} voxels, {:.1f} mm3\n", filled.parts, filled.voxels,
               static_cast<double>(filled.voxels) * voxel);
  }
  if (options.largest) {
    const bone::TidyResult left = bone::keep_largest_part(model);
    bone::crop_to_bone(model);
    fmt::print("left out    {} loose parts of bone: {} voxels\n", left.parts, left.voxels);
  }
}

int bone_import(const BoneImportOptions& options) {
  const MemoryBudget budget(options.max_memory);
  check_new_bone(options);
  check_new_figure(options.histogram, options.overwrite);
  check_fill(options);
  bone::LoadOptions load = load_options(options, budget);
  load.crop = chosen_box(options);
  load.segments = options.segmentation;
  load.meshes = meshes_of(options);
  if (!options.histogram.empty()) {
    load.findings = [&](const bone::GreyFindings& findings) { draw_histogram(options, findings); };
  }
  ShownWork work("importing");
  bone::BoneModel model = bone::load_bone(options.in, load, work.report());
  tidy(options, model);
  print_bone(model);
  print_warnings(model);
  save_new_bone(options, model);
  return 0;
}

}  // namespace

void add_bone_import(CLI::App& bone, int& status) {
  CLI::App* sub =
      subcommand(bone, "import", "Make a bone from CT or from labels",
                 "haptrial bone import head.nii.gz head.nrrd --threshold 300 --spacing 0.5",
                 {"the bone OUT", "guide-scan.md"});
  auto& o = options_of<BoneImportOptions>(*sub, status, bone_import);
  add_bone_input(*sub, o);
  add_bone_output(*sub, o);
  add_bone_box(*sub, o);
  sub->add_option("--segmentation", o.segmentation,
                  "Structures of the scan as 3D Slicer saves them (.seg.nrrd)");
  sub->add_option("--structure", o.structures,
                  "Structure as a mesh: NAME=FILE (.stl, .obj, .ply) [mm]; may be repeated")
      ->allow_extra_args(false);
  sub->add_option("--mesh-axes", o.mesh_axes,
                  with_default("Axes of meshes: lps, ras or auto, as their files say",
                               o.mesh_axes + ", then lps"));
  sub->add_flag("--largest", o.largest, "Leave out loose parts of bone: keep the largest");
  sub->add_option("--fill", o.fill, "Largest hole to fill with bone [mm3] (default: none)");
  sub->add_option("--histogram", o.histogram,
                  "New picture of a grey volume's values and thresholds (.png, .svg)");
}

}  // namespace haptrial::experiments
