#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "analysis/bone_drilling/feel/feel_fit.h"
#include "analysis/files/csv.h"
#include "core/base/definition/given_values.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/nearest.h"
#include "core/base/whole_file.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/studies/experiment.h"
#include "protocols/bone_drilling/definition/bone_definition.h"

namespace haptrial::experiments {
namespace {

namespace drilling = analysis::drilling;

struct FitFeelOptions {
  std::string file;
  std::string definition;
  std::string tool;
  std::string out;
  bool overwrite{false};
};

/// Radius of the burr with which was measured [m].
double radius_of(const protocols::BoneDefinition& d, const std::string& tool) {
  std::vector<std::string> burrs;
  for (const bone::ToolSpec& spec : d.simulator.tools) {
    const auto* burr = spec.as<bone::BurrTool>();
    if (burr != nullptr && burr->burr.form == bone::BurrForm::kBall) {
      if (spec.name == tool) {
        return burr->radius();
      }
      burrs.push_back(spec.name);
    }
  }
  if (burrs.empty()) {
    throw InputError(
        fmt::format("{}: has no burr that is a ball, of which the law is fitted", d.file_name));
  }
  throw InputError(not_allowed("--tool", fmt::format("'{}'", tool), burrs));
}

void print(const char* key, const drilling::FeelEstimate& e, const char* unit) {
  fmt::print("{:<14} {:>11.4g}   95 % from {:.4g} to {:.4g} {}\n", key, e.value, e.low, e.high,
             unit);
}

/// Prints the fit. @returns its values as keys of the tool
std::vector<GivenKey> tell(const drilling::FeelFit& fit, const std::string& tool) {
  std::vector<GivenKey> given;
  const auto add = [&](const char* key, const drilling::FeelEstimate& e, const char* unit) {
    print(key, e, unit);
    given.push_back({fmt::format("tools.{}.{}", tool, key), fmt::format("{:.6e}", e.value)});
  };
  fmt::print("force          {} samples in contact, {:.3f} N about the law\n", fit.pressed,
             fit.force_error);
  add("feel.first_gain", fit.first_gain, "N/m^3");
  add("feel.second_gain", fit.second_gain, "N/m^3");
  add("feel.threshold", fit.threshold, "m^3");
  if (!fit.removal_rate) {
    fmt::print(
        "removal        not fitted: it needs 20 samples with a feed, at tilts or depths whose "
        "latitudes differ by 0.1 rad; {} have one\n",
        fit.drilled);
    return given;
  }
  fmt::print("removal        {} samples with a feed\n", fit.drilled);
  add("removal_rate", *fit.removal_rate, "1/(N·s)");
  add("falloff", *fit.falloff, "1/(N·s·rad)");
  return given;
}

int bone_fit_feel(const FitFeelOptions& options) {
  check_new(options.out, options.overwrite);
  const Experiment experiment = load_experiment(options.definition);
  const auto* d = dynamic_cast<const protocols::BoneDefinition*>(experiment.definition.get());
  if (d == nullptr) {
    throw InputError(
        fmt::format("{}: is no drilling; choose a definition with protocol = \"bone_drilling\"",
                    options.definition));
  }
  const double radius = radius_of(*d, options.tool);
  const analysis::CsvTable table = analysis::CsvTable::load(options.file);
  const auto given =
      tell(drilling::fit_feel(radius, drilling::read_feel_samples(table, radius)), options.tool);
  // The definition says what it does not take, such as a second gain below the first.
  protocols::parse_bone_definition(with_values(d->text, options.definition, given),
                                   options.definition);
  if (!options.out.empty()) {
    WholeFile file(options.out, options.overwrite);
    file.write(with_values(file_text(options.definition), options.definition, given));
    file.finish();
    fmt::print("wrote          {}\n", options.out);
  }
  return 0;
}

}  // namespace

void add_bone_fit_feel(CLI::App& bone, int& status) {
  CLI::App* sub = subcommand(
      bone, "fit-feel", "Fit a burr's force law and removal to a recorded trace",
      "haptrial bone fit-feel press.csv --definition study.toml --tool cutting --out fitted.toml",
      {"the file OUT, the definition with the fitted keys",
       "guide-bone.md#feel-from-measurements"});
  auto& o = options_of<FitFeelOptions>(*sub, status, bone_fit_feel);
  sub->add_option("FILE", o.file,
                  "Trace of a ball pressed on flat bone (.csv): columns depth [m] and force [N]; "
                  "while it drills feed [m/s]; tilt [rad] of the handle from the normal")
      ->required();
  sub->add_option("--definition", o.definition, "Definition of a drilling with that burr (.toml)")
      ->required();
  sub->add_option("--tool", o.tool, "Name of the burr in the definition's [tools]")->required();
  sub->add_option("--out", o.out, "New definition with the fitted keys (default: none is written)");
  sub->add_flag("--overwrite", o.overwrite, "Overwrite an existing file");
}

}  // namespace haptrial::experiments
