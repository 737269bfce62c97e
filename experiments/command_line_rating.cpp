// Ratings of drillings.

#include "experiments/command_line_internal.h"

namespace haptrial::experiments {
namespace {

void add_prepare(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(
      rate, "prepare", "Make films or sheets under random codes, a rating sheet and a sealed key",
      "haptrial rate prepare out/validity-001 --sheets");
  auto& o = options_of<RatePrepareOptions>(*sub, status, rate_prepare);
  sub->add_option("DIR", o.folder, "Folder of drilling sessions (.h5)")->required();
  sub->add_option("--out", o.out, "New folder for the raters (DIR-rating)");
  sub->add_flag("--sheets", o.sheets, "Pictures in place of films");
  sub->add_option("--frames", o.frames, "Pictures on a sheet (12)");
  sub->add_option("--speed", o.speed, "Of films, times as fast as it went (8)");
  sub->add_flag("--half-points", o.halves, "Allow scores such as 3.5");
  sub->add_option("--jobs", o.jobs, "Threads; one per processor by default");
}

void add_import(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(rate, "import", "Read filled-in sheets into a study",
                             "haptrial rate import smith.csv li.csv --study out/validity-001");
  auto& o = options_of<RateImportOptions>(*sub, status, rate_import);
  sub->add_option("SHEET", o.sheets, "Filled-in sheets (.csv), one for each rater")->required();
  sub->add_option("--study", o.folder, "Folder that was prepared")->required();
  sub->add_flag("--overwrite", o.overwrite, "Replace ratings that are there");
}

void add_simulate(CLI::App& rate, int& status) {
  CLI::App* sub =
      subcommand(rate, "simulate", "Let two simulated raters score a dry run by the written rubric",
                 "haptrial rate simulate out/construct_validity-001");
  auto& o = options_of<RateSimulateOptions>(*sub, status, rate_simulate);
  sub->add_option("DIR", o.folder, "Folder of drilling sessions (.h5)")->required();
  sub->add_flag("--overwrite", o.overwrite, "Replace ratings that are there");
  sub->add_option("--jobs", o.jobs, "Threads; one per processor by default");
}

}  // namespace

void add_rate(CLI::App& app, int& status) {
  CLI::App* rate = subcommand(app, "rate", "Let raters score drillings blindly",
                              "haptrial rate prepare out/validity-001 --sheets");
  rate->require_subcommand(1);
  add_prepare(*rate, status);
  add_import(*rate, status);
  add_simulate(*rate, status);
}

}  // namespace haptrial::experiments
