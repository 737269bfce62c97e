#include "analysis/write_analysis.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "analysis/figure_gnuplot.h"
#include "analysis/report.h"
#include "analysis/scores_csv.h"
#include "analysis/study_figures.h"
#include "analysis/study_json.h"
#include "core/base/error.h"

namespace haptrial::analysis {
namespace {

namespace fs = std::filesystem;

// A folder within the final one, so that moving a file out of it is a rename. Gone at the end.
class Staging {
 public:
  explicit Staging(const fs::path& folder)
      : final_(folder), path_(folder / fmt::format(".analysis-{}", getpid())) {
    std::error_code error;
    fs::create_directories(final_, error);
    if (!fs::is_directory(final_)) {
      throw InputError(
          fmt::format("{}: is not a folder and cannot become one ({}); allowed: a "
                      "folder that may be written",
                      final_.string(), error.message()));
    }
    fs::remove_all(path_, error);
    if (!fs::create_directory(path_, error)) {
      throw InputError(
          fmt::format("{}: cannot be written ({}); allowed: a folder that may be "
                      "written",
                      final_.string(), error.message()));
    }
  }
  ~Staging() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;

  const fs::path& path() const { return path_; }

  void write(const std::string& name, const std::string& text) const {
    errno = 0;
    std::ofstream file(path_ / name, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) {
      throw RunError(fmt::format("{}: could not be written: {}", (final_ / name).string(),
                                 std::strerror(errno)));
    }
  }

  // Moves everything to its place, each file at once.
  void publish() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(path_)) {
      files.push_back(entry.path().filename());
    }
    for (const auto& name : files) {
      std::error_code error;
      fs::rename(path_ / name, final_ / name, error);
      if (error) {
        throw RunError(fmt::format("{}: could not be put in place: {}", (final_ / name).string(),
                                   error.message()));
      }
    }
  }

 private:
  fs::path final_;
  fs::path path_;
};

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

void write_analysis(const StudyResult& study, const fs::path& folder) {
  const Staging staging(folder);
  staging.write("scores.csv", scores_csv(study.scores));
  staging.write("statistics.json", statistics_json(study));
  const auto figures = study_figures(study);
  draw_figures(figures, staging.path());
  std::vector<Drawing> drawings;
  for (const auto& figure : figures) {
    drawings.push_back({figure, contents(staging.path() / (figure.name + ".svg"))});
  }
  const Document report = study_report(study, drawings);
  staging.write("report.html", to_html(report));
  staging.write("report.md", to_markdown(report));
  staging.publish();
}

}  // namespace haptrial::analysis
