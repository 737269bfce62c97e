#include "analysis/bone_drilling/phases/phase_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/file_text.h"

namespace haptrial::analysis::drilling {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKind = "haptrial phases of drillings";

Json rows_of(const Eigen::MatrixXd& matrix) {
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    const Eigen::VectorXd values = matrix.row(row).transpose();
    rows.push_back(std::vector<double>(values.begin(), values.end()));
  }
  return rows;
}

/// A matrix of finite numbers. @throws std::invalid_argument for another size
Eigen::MatrixXd matrix_of(const Json& rows, std::size_t height, std::size_t width) {
  const auto all = rows.get<std::vector<std::vector<double>>>();
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(height), static_cast<Eigen::Index>(width));
  if (all.size() != height) {
    throw std::invalid_argument("rows");
  }
  for (std::size_t row = 0; row < height; ++row) {
    if (all[row].size() != width) {
      throw std::invalid_argument("columns");
    }
    matrix.row(static_cast<Eigen::Index>(row)) =
        Eigen::Map<const Eigen::RowVectorXd>(all[row].data(), matrix.cols());
  }
  return matrix;
}

PhaseModel model_of(const Json& root) {
  PhaseModel model;
  model.study = root.at("study");
  model.participants = root.at("participants");
  model.procedures = root.at("procedures");
  model.labelled = root.at("labelled");
  model.simulated = root.at("simulated");
  model.phases = root.at("phases").get<std::vector<std::string>>();
  const std::size_t phases = model.phases.size();
  model.chain.start = matrix_of(root.at("log_start"), 1, phases).row(0).transpose();
  model.chain.transition = matrix_of(root.at("log_transition"), phases, phases);
  for (std::size_t w = 0; w < kActionWords; ++w) {
    const Json& words = root.at("words").at(std::string(kActionWordNames[w]));
    model.words[w].words = words.at("words").get<std::vector<std::string>>();
    model.words[w].log_share =
        matrix_of(words.at("log_share"), phases, model.words[w].words.size() + 1);
  }
  const Json& numbers = root.at("numbers");
  if (numbers.at("names") != Json(kActionNumberNames)) {
    throw std::invalid_argument("numbers");
  }
  model.mean = matrix_of(numbers.at("mean"), phases, kActionNumbers);
  model.deviation = matrix_of(numbers.at("deviation"), phases, kActionNumbers);
  if (phases == 0 || !(model.deviation.array() > 0.0).all()) {
    throw std::invalid_argument("deviation");
  }
  return model;
}

}  // namespace

std::string phase_model_text(const PhaseModel& model) {
  Json root{{"kind", kKind},
            {"study", model.study},
            {"participants", model.participants},
            {"procedures", model.procedures},
            {"labelled", model.labelled},
            {"simulated", model.simulated},
            {"phases", model.phases},
            {"log_start", rows_of(model.chain.start.transpose())},
            {"log_transition", rows_of(model.chain.transition)}};
  for (std::size_t w = 0; w < kActionWords; ++w) {
    root["words"][std::string(kActionWordNames[w])] = {
        {"words", model.words[w].words}, {"log_share", rows_of(model.words[w].log_share)}};
  }
  root["numbers"] = {{"names", kActionNumberNames},
                     {"mean", rows_of(model.mean)},
                     {"deviation", rows_of(model.deviation)}};
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

PhaseModel read_phase_model(const std::filesystem::path& file) {
  const std::string text = file_text(file);
  try {
    const Json root = Json::parse(text);
    if (root.is_object() && root.value("kind", "") == kKind) {
      return model_of(root);
    }
  } catch (const Json::exception&) {        // said below
  } catch (const std::invalid_argument&) {  // likewise
  }
  throw InputError(fmt::format(
      "{}: is not a file of phases; allowed: one that haptrial bone phases wrote", file.string()));
}

}  // namespace haptrial::analysis::drilling
