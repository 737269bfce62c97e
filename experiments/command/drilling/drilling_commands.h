#pragma once

#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

// Each subcommand prints to standard output and returns an exit status. Bad input and failures come
// as InputError and RunError.

struct BoneStagesOptions {
  std::string definition;
  std::string out;  // new folder
  int count{4};     // of stills
};
int bone_stages(const BoneStagesOptions& options);

/// The subcommands of haptrial rate.
struct RatePrepareOptions {
  std::string folder;  // of drilling sessions
  std::string out;     // new folder for the raters; default: beside the study's
  bool sheets{false};  // pictures in place of films
  bool halves{false};  // half points are allowed
  int frames{12};      // on a sheet
  double speed{8.0};   // of films, times as fast as it went
  std::optional<int> jobs;
};
int rate_prepare(const RatePrepareOptions& options);

struct RateImportOptions {
  std::string folder;               // of the study
  std::vector<std::string> sheets;  // one for each rater
  bool overwrite{false};
};
int rate_import(const RateImportOptions& options);

struct RateSimulateOptions {
  std::string folder;  // of a study
  std::optional<int> jobs;
  bool overwrite{false};
};
int rate_simulate(const RateSimulateOptions& options);

struct BoneExportOptions {
  std::string in;            // bone or session (.h5)
  std::string out;           // new .nrrd, .stl, .obj or .ply
  std::optional<int> trial;  // of a session; default: the first
  std::string structure;     // of a mesh; empty: the whole surface
  bool ras{false};           // axes of a mesh: else LPS
  bool overwrite{false};
};
int bone_export(const BoneExportOptions& options);

struct BonePlaceOptions {
  std::string definition;
  std::string out;  // new .png
  int bone{1};      // of the definition's, from 1
  bool overwrite{false};
};
int bone_place(const BonePlaceOptions& options);

struct BonePageOptions {
  std::vector<std::string> sessions;  // of bone drilling (.h5), of one participant
  std::vector<std::string> experts;   // sessions to compare with
  std::string study;                  // folder of sessions; empty: none
  std::string out;                    // new .html
  std::optional<int> trial;           // default: all
  bool overwrite{false};
};
int bone_page(const BonePageOptions& options);

struct BoneSafeOptions {
  std::vector<std::string> experts;  // sessions to learn from (.h5)
  std::string study;                 // folder of sessions; empty: none
  std::string out;                   // new .toml
  bool overwrite{false};
};
int bone_safe(const BoneSafeOptions& options);

}  // namespace haptrial::experiments
