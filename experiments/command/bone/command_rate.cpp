// haptrial rate: what raters need to judge procedures without knowing whose they are, and what they
// found back into the study.

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <set>

#include "analysis/bone_drilling/checklist/checklist_sheet.h"
#include "analysis/bone_drilling/report/ratings.h"
#include "analysis/files/staging.h"
#include "core/base/counted.h"
#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "core/base/parallel.h"
#include "core/record/read/session_reader.h"
#include "experiments/command/arguments.h"
#include "experiments/command/subcommand.h"
#include "experiments/control/progress.h"
#include "experiments/control/signals.h"
#include "experiments/studies/drilling/drilling_study.h"
#include "experiments/studies/drilling/expert_sessions.h"
#include "experiments/studies/drilling/rating_pictures.h"
#include "experiments/study/session_name.h"
#include "experiments/study/study_files.h"
#include "protocols/bone_drilling/bone_replay.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

struct RatePrepareOptions {
  std::string folder;
  std::string out;
  std::string checklist;
  bool sheets{false};
  bool halves{false};
  int frames{12};
  double speed{8.0};
  std::optional<int> jobs;
};

struct RateImportOptions {
  std::string folder;
  std::vector<std::string> sheets;
  bool overwrite{false};
};

namespace drilling = analysis::drilling;

constexpr const char* kKeyFile = "ratings.key";
constexpr const char* kSheetFile = "rating-sheet.csv";
constexpr const char* kPageFile = "checklist.html";

std::string instructions(bool sheets, bool halves) {
  const std::string how =
      sheets ? "Each picture CODE.png is one procedure: small pictures at evenly spaced moments, "
               "from left to\nright and from top to bottom, and below them the cavity at the end.\n"
             : "Each film CODE.mp4 is one procedure, played several times as fast as real time; at "
               "its end the cavity\nstands still for some seconds.\n";
  return how +
         fmt::format(
             "\nGive every procedure a score in {0}, whole{1} points from 1 to 5, as you would in "
             "a training\nlaboratory:\n\n"
             "  5  a surgeon's work: everything planned is removed, nothing vital is touched, the\n"
             "     cavity is open and smooth\n"
             "  4  good: small remainders or roughness, nothing vital is touched\n"
             "  3  fair: parts of the plan are left, or bone is removed that should stand\n"
             "  2  poor: much is left or too much removed, or a vital structure is touched\n"
             "  1  unsafe or hardly begun\n\n"
             "Judge each by itself, in any order, and finish without talking to other raters. Save "
             "the sheet\nunder your own name (SURNAME.csv). Comments are welcome. The codes mean "
             "nothing.\n",
             kSheetFile, halves ? " or half" : "");
}

/// Fingerprint of the bone's changes and their times, without the participant.
std::uint64_t fingerprint(const record::SessionReader& session, int trial) {
  Fnv1a hash;
  const std::vector<record::RemovalRow> removals = session.rows<record::RemovalRow>();
  for (const record::PassRow& pass : session.passes()) {
    if (pass.trial != trial) {
      continue;
    }
    hash.add(pass.last_sample - pass.first_sample);
    for (const record::RemovalRow& row : removals) {
      if (row.sequence >= pass.first_sample && row.sequence <= pass.last_sample) {
        hash.add(row.sequence - pass.first_sample);
        for (const std::int32_t index : row.voxel) {
          hash.add(static_cast<std::uint64_t>(index));
        }
      }
    }
  }
  return hash.value();
}

/// The same time for every file: when it was made would give the order of sessions away.
void hide_time(const fs::path& file) {
  constexpr std::int64_t kSecond = 946'684'800;  // 2000-01-01
  const timespec times[2] = {{kSecond, 0}, {kSecond, 0}};
  if (utimensat(AT_FDCWD, file.c_str(), times, 0) != 0) {
    throw RunError(fmt::format("{}: its time cannot be set", file.string()));
  }
}

struct Procedures {
  std::vector<fs::path> files;  // (items)
  std::vector<drilling::RatedItem> items;
  std::uint64_t seed{0};
};

Procedures procedures_in(const fs::path& folder) {
  Procedures found;
  for (const fs::path& file : files_of(folder, Pilots::kLeftOut)) {
    const record::SessionReader session(file);
    found.seed = session.info().seed;
    for (const int trial : protocols::BoneReplay(file).trials()) {
      found.files.push_back(file);
      found.items.push_back({file.filename().string(), trial, fingerprint(session, trial)});
    }
  }
  if (found.items.empty()) {
    throw InputError(fmt::format("{}: no session holds a drilling to be rated", folder.string()));
  }
  return found;
}

void make_pictures(const Procedures& procedures, const drilling::RatingKey& key,
                   const RatePrepareOptions& options, const fs::path& folder, int threads) {
  Progress progress("rate prepare", static_cast<double>(key.entries.size()));
  std::atomic<int> done{0};
  in_groups(key.entries.size(), 1, threads, [&] {
    return [&](std::size_t first, std::size_t) {
      if (interrupted()) {
        throw RunError("interrupted; nothing was written");
      }
      const drilling::KeyEntry& entry = key.entries[first];
      const auto item = std::find(procedures.items.begin(), procedures.items.end(), entry.item);
      const protocols::BoneReplay replay(
          procedures.files[static_cast<std::size_t>(item - procedures.items.begin())]);
      const fs::path file = folder / (entry.code + (options.sheets ? ".png" : ".mp4"));
      if (options.sheets) {
        render::write_png(file, frame_sheet(replay, entry.item.procedure, options.frames));
      } else {
        film(replay, entry.item.procedure, file, options.speed);
      }
      hide_time(file);
      ++done;
    };
  });
  progress.update(done, fmt::format("{} procedures", done.load()), 1.0);
}

std::vector<std::string> codes_of(const drilling::RatingKey& key) {
  std::vector<std::string> codes;
  for (const drilling::KeyEntry& entry : key.entries) {
    codes.push_back(entry.code);
  }
  return codes;
}

/// The points that a checklist's measures propose for each procedure of a study, in the key's
/// order.
std::vector<drilling::CheckedItem> proposed(const drilling::Checklist& checklist,
                                            const drilling::RatingKey& key, const fs::path& study,
                                            const char* ending, const std::string& name) {
  drilling::StudyBones bones;
  ExpertSessions sessions({}, bones);
  for (const fs::path& file : files_of(study, Pilots::kLeftOut)) {
    sessions.add(file);
  }
  std::vector<drilling::CheckedItem> items;
  for (const drilling::KeyEntry& entry : key.entries) {
    for (const ExpertSession& each : sessions.procedures()) {
      const drilling::ProcedureSummary& summary = each.procedure.summary;
      if (summary.session != entry.item.session || summary.number != entry.item.procedure) {
        continue;
      }
      check_measures(checklist, summary, name);
      drilling::CheckedItem item{entry.code, entry.code + ending, {}};
      for (const drilling::ChecklistItem& question : checklist.items) {
        item.proposed.push_back(proposed_points(question, summary));
      }
      items.push_back(std::move(item));
    }
  }
  return items;
}

void must_be_new(const fs::path& path, const char* remedy) {
  std::error_code error;
  if (fs::exists(path, error) && !(fs::is_directory(path, error) && fs::is_empty(path, error))) {
    throw InputError(fmt::format("{}: exists already; {}", path.string(), remedy));
  }
}

int rate_prepare(const RatePrepareOptions& options) {
  const int threads = checked_jobs(options.jobs);
  constexpr int kMostFrames = 48;
  checked_number("--frames", options.frames, 2, kMostFrames);
  constexpr double kFastest = 1000.0;
  if (!(options.speed >= 1.0 && options.speed <= kFastest)) {
    throw InputError(fmt::format("--speed is {}; allowed: 1 to {}", options.speed, kFastest));
  }
  const fs::path study(options.folder);
  const Procedures procedures = procedures_in(study);
  const fs::path folder =
      options.out.empty() ? fs::path(fs::absolute(study).lexically_normal().string() + "-rating")
                          : fs::path(options.out);
  must_be_new(folder, "choose a new folder for the raters");
  must_be_new(study / kKeyFile,
              "remove it to prepare the study again, but sheets with the old codes are then lost");
  watch_for_interrupt();
  const drilling::RatingKey key =
      drilling::blinded(procedures.items, procedures.seed, options.halves);
  std::string page;
  if (!options.checklist.empty()) {
    const drilling::Checklist checklist = drilling::load_checklist(options.checklist);
    page = drilling::checklist_page(
        checklist,
        proposed(checklist, key, study, options.sheets ? ".png" : ".mp4", options.checklist));
  }
  {
    const analysis::Staging staging(folder);
    make_pictures(procedures, key, options, staging.path(), threads);
    staging.write(kSheetFile, drilling::rating_sheet(key));
    staging.write("instructions.txt", instructions(options.sheets, options.halves));
    hide_time(staging.path() / kSheetFile);
    hide_time(staging.path() / "instructions.txt");
    const analysis::Staging beside(study);
    beside.write(kKeyFile, drilling::sealed(key));
    if (!page.empty()) {
      staging.write(kPageFile, page);
      hide_time(staging.path() / kPageFile);
      beside.write(kChecklistFile, file_text(options.checklist));
    }
    beside.publish();
    staging.publish();
  }
  fmt::print("{} under codes: {}\n", counted(key.entries.size(), "procedure", "procedures"),
             folder.string());
  fmt::print("key, sealed until import: {}\n", (study / kKeyFile).string());
  return 0;
}

/// Opens the codes of raters' checklists and writes them into the study.
void import_checklists(const std::vector<std::string>& sheets, const fs::path& study,
                       const drilling::RatingKey& key) {
  const fs::path file = study / kChecklistFile;
  if (!fs::exists(file)) {
    throw InputError(fmt::format(
        "{}: no such file; run haptrial rate prepare with --checklist for the study first",
        file.string()));
  }
  const drilling::Checklist checklist = drilling::load_checklist(file);
  const auto items = proposed(checklist, key, study, "", file.string());
  std::vector<drilling::CheckedRow> all;
  std::set<std::string> raters;
  for (const std::string& sheet : sheets) {
    for (drilling::CheckedRow& row :
         drilling::read_checklist_sheet(sheet, checklist, codes_of(key))) {
      const auto at = std::find_if(items.begin(), items.end(),
                                   [&](const auto& item) { return item.code == row.session; });
      const auto entry = std::find_if(key.entries.begin(), key.entries.end(),
                                      [&](const auto& each) { return each.code == row.session; });
      for (std::size_t n = 0; n < row.proposed.size(); ++n) {
        row.proposed[n] = at->proposed[n].value_or(-1);
      }
      row.session = entry->item.session;
      row.procedure = entry->item.procedure;
      all.push_back(std::move(row));
    }
    if (!raters.insert(all.back().rater).second) {
      throw InputError(
          fmt::format("{}: rater {} has another checklist already; name each rater's "
                      "sheet after the rater",
                      sheet, all.back().rater));
    }
  }
  const analysis::Staging staging(study);
  staging.write(kCheckedFile, drilling::checked_csv(checklist, all));
  staging.publish();
  fmt::print("{} by {}: {}\n", counted(all.size(), "checklist", "checklists"),
             counted(raters.size(), "rater", "raters"), (study / kCheckedFile).string());
}

/// A sheet goes on naming who has withdrawn by a code; nothing of them comes back into the study.
void leave_out_gone(std::vector<drilling::Rating>& ratings, const fs::path& study) {
  std::set<std::string> gone;
  std::erase_if(ratings, [&](const drilling::Rating& rating) {
    const bool there =
        fs::exists(study / rating.session) || fs::exists(study / kExcludedFolder / rating.session);
    if (!there) {
      gone.insert(rating.session);
    }
    return !there;
  });
  if (!gone.empty()) {
    fmt::print("{} that {} no longer in the study: ratings left out\n",
               counted(gone.size(), "session", "sessions"), gone.size() == 1 ? "is" : "are");
  }
}

int rate_import(const RateImportOptions& options) {
  const fs::path study(options.folder);
  const fs::path key_file = study / kKeyFile;
  if (!fs::exists(key_file)) {
    throw InputError(fmt::format("{}: no such file; run haptrial rate prepare for the study first",
                                 key_file.string()));
  }
  const drilling::RatingKey key = drilling::opened(file_text(key_file), key_file.string());
  std::vector<std::string> sheets, checklists;
  for (const std::string& sheet : options.sheets) {
    (drilling::is_checklist_sheet(sheet) ? checklists : sheets).push_back(sheet);
  }
  if (!options.overwrite && !sheets.empty()) {
    must_be_new(study / kRatingsFile, "choose a study without ratings or add --overwrite");
  }
  if (!options.overwrite && !checklists.empty()) {
    must_be_new(study / kCheckedFile, "choose a study without checklists or add --overwrite");
  }
  if (!checklists.empty()) {
    import_checklists(checklists, study, key);
  }
  if (sheets.empty()) {
    return 0;
  }
  std::vector<drilling::Rating> ratings;
  std::set<std::string> raters;
  for (const std::string& sheet : sheets) {
    const auto own = drilling::read_sheet(sheet, key);
    if (!raters.insert(own.front().rater).second) {
      throw InputError(fmt::format(
          "{}: rater {} has another sheet already; name each rater's sheet after the rater", sheet,
          own.front().rater));
    }
    ratings.insert(ratings.end(), own.begin(), own.end());
  }
  leave_out_gone(ratings, study);
  const analysis::Staging staging(study);
  staging.write(kRatingsFile, drilling::ratings_csv(ratings));
  staging.publish();
  fmt::print("{} by {}: {}\n", counted(ratings.size(), "rating", "ratings"),
             counted(raters.size(), "rater", "raters"), (study / kRatingsFile).string());
  for (const drilling::KeyEntry& entry : key.entries) {
    fmt::print("{}  {} procedure {}\n", entry.code, entry.item.session, entry.item.procedure);
  }
  return 0;
}

void add_rate_prepare(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(
      rate, "prepare", "Make films or sheets under random codes, a rating sheet and a sealed key",
      "haptrial rate prepare out/validity-001 --sheets");
  auto& o = options_of<RatePrepareOptions>(*sub, status, rate_prepare);
  sub->add_option("DIR", o.folder, "Folder of drilling sessions (.h5)")->required();
  sub->add_option("--out", o.out, "New folder for the raters (default: DIR-rating)");
  sub->add_flag("--sheets", o.sheets, "Make sheets of pictures in place of films");
  sub->add_option("--checklist", o.checklist,
                  "Checklist (.toml) that raters fill in on a page beside the films");
  sub->add_option("--frames", o.frames, with_default("Number of pictures on a sheet", o.frames));
  sub->add_option("--speed", o.speed,
                  with_default("Speed of the films, in multiples of real time", o.speed));
  sub->add_flag("--half-points", o.halves, "Allow half points, such as 3.5");
  sub->add_option("--jobs", o.jobs, kJobsHelp);
}

void add_rate_import(CLI::App& rate, int& status) {
  CLI::App* sub = subcommand(rate, "import", "Read completed rating sheets into a study",
                             "haptrial rate import smith.csv li.csv --study out/validity-001");
  auto& o = options_of<RateImportOptions>(*sub, status, rate_import);
  sub->add_option("SHEET", o.sheets, "Completed rating sheets (.csv), one for each rater")
      ->required();
  sub->add_option("--study", o.folder, "Folder of the study that was prepared")->required();
  sub->add_flag("--overwrite", o.overwrite, "Overwrite existing ratings");
}

}  // namespace

void add_rate(CLI::App& app, int& status) {
  CLI::App* rate = subcommand(app, "rate", "Prepare and import blind ratings of drillings",
                              "haptrial rate prepare out/validity-001 --sheets");
  rate->require_subcommand(1);
  add_rate_prepare(*rate, status);
  add_rate_import(*rate, status);
  add_rate_simulate(*rate, status);
}

}  // namespace haptrial::experiments
