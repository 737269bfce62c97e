// Ratings of drillings.

#include "experiments/command/drilling/drilling_commands.h"
#include "experiments/command/line/command_lines.h"
#include "experiments/command/line/subcommand_internal.h"

namespace haptrial::experiments {
namespace {

void add_prepare(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(
      rate, "prepare", "Make films or sheets under random codes, a rating sheet and a sealed key",
      "haptrial rate prepare out/validity-001 --sheets");
  auto& o = options_of<RatePrepareOptions>(*sub, status, rate_prepare);
  sub->add_option("DIR", o.folder, "Folder of drilling sessions (.h5)")->required();
  sub->add_option("--out", o.out, "New folder for the raters (default: DIR-rating)");
  sub->add_flag("--sheets", o.sheets, "Make sheets of pictures in place of films");
  sub->add_option("--frames", o.frames, "Number of pictures on a sheet (default: 12)");
  sub->add_option("--speed", o.speed, "Speed of the films, in multiples of real time (default: 8)");
  sub->add_flag("--half-points", o.halves, "Allow half points, such as 3.5");
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
}

void add_rating_import(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(rate, "import", "Read completed rating sheets into a study",
                             "haptrial rate import smith.csv li.csv --study out/validity-001");
  auto& o = options_of<RateImportOptions>(*sub, status, rate_import);
  sub->add_option("SHEET", o.sheets, "Completed rating sheets (.csv), one for each rater")
      ->required();
  sub->add_option("--study", o.folder, "Folder of the study that was prepared")->required();
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing ratings");
}

void add_simulate(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(
      rate, "simulate", "Score a dry run with two simulated raters, who follow the written rubric",
      "haptrial rate simulate out/construct_validity-001");
  auto& o = options_of<RateSimulateOptions>(*sub, status, rate_simulate);
  sub->add_option("DIR", o.folder, "Folder of drilling sessions (.h5)")->required();
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing ratings");
  sub->add_option("--jobs", o.jobs, "Number of threads (default: one per processor)");
}

}  // namespace

void add_rate(CLI::App& app, int& status) {
  CLI::App* rate = subcommand(app, "rate", "Prepare and import blind ratings of drillings",
                              "haptrial rate prepare out/validity-001 --sheets");
  rate->require_subcommand(1);
  add_prepare(*rate, status);
  add_rating_import(*rate, status);
  add_simulate(*rate, status);
}

}  // namespace haptrial::experiments
