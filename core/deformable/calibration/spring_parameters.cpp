#include "core/deformable/calibration/spring_parameters.h"

#include <cmath>
#include <map>
#include <numbers>

#include "core/deformable/springs/law/spring_grid.h"

namespace haptrial::deformable {

template <std::size_t n>
SpringParameters::Rows SpringParameters::rows_of(
    const std::vector<std::array<std::int32_t, n>>& springs,
    const std::vector<std::vector<Share>>& at_vertex) {
  Rows rows;
  for (const auto& vertices : springs) {
    std::map<std::int32_t, double> sum;
    for (const std::int32_t v : vertices) {
      for (const Share& share : at_vertex[static_cast<std::size_t>(v)]) {
        sum[share.node] += share.weight / static_cast<double>(n);
      }
    }
    for (const auto& [node, weight] : sum) {
      rows.share.push_back({node, weight});
    }
    rows.start.push_back(rows.share.size());
  }
  return rows;
}

SpringParameters::SpringParameters(const SpringBody& body, std::size_t nodes,
                                   const std::vector<std::vector<Share>>& at_vertex)
    : nodes_(nodes),
      rows_{rows_of(body.parts.edges, at_vertex), rows_of(body.parts.faces, at_vertex),
            rows_of(body.tetrahedra, at_vertex)} {}

SpringParameters SpringParameters::uniform(const SpringBody& body) {
  return {body, 1, std::vector<std::vector<Share>>(body.rest.size(), {{0, 1.0}})};
}

SpringParameters SpringParameters::on_grid(const SpringBody& body,
                                           const std::array<int, 3>& nodes) {
  const SpringGrid grid(body, nodes);
  const std::size_t used = grid.used().size();
  std::vector<std::vector<Share>> at_vertex(body.rest.size());
  std::vector<double> values(used, 0.0);
  for (std::size_t node = 0; node < used; ++node) {
    values[node] = 1.0;
    const std::vector<double> weights = grid.at_vertices(values);
    values[node] = 0.0;
    for (std::size_t v = 0; v < weights.size(); ++v) {
      if (weights[v] > 0.0) {
        at_vertex[v].push_back({static_cast<std::int32_t>(node), weights[v]});
      }
    }
  }
  return {body, used, at_vertex};
}

namespace {

/// The lists of a kind: 0 lengths, 1 areas, 2 volumes.
auto& list_of(auto& constants, std::size_t kind) {
  return kind == 0 ? constants.length : kind == 1 ? constants.area : constants.volume;
}

}  // namespace

SpringConstants SpringParameters::constants(std::span<const double> logarithms) const {
  SpringConstants constants;
  for (std::size_t kind = 0; kind < rows_.size(); ++kind) {
    std::vector<double> values;
    for (const double x : logarithms.subspan(kind * nodes_, nodes_)) {
      values.push_back(std::pow(10.0, x));
    }
    const Rows& rows = rows_[kind];
    for (std::size_t spring = 0; spring + 1 < rows.start.size(); ++spring) {
      double sum = 0.0;
      for (std::size_t i = rows.start[spring]; i < rows.start[spring + 1]; ++i) {
        sum += rows.share[i].weight * values[static_cast<std::size_t>(rows.share[i].node)];
      }
      list_of(constants, kind).push_back(sum);
    }
  }
  return constants;
}

std::vector<double> SpringParameters::gradient(std::span<const double> logarithms,
                                               const SpringConstants& by_constant) const {
  std::vector<double> result(size(), 0.0);
  for (std::size_t kind = 0; kind < rows_.size(); ++kind) {
    const Rows& rows = rows_[kind];
    const std::vector<double>& by_spring = list_of(by_constant, kind);
    for (std::size_t spring = 0; spring < by_spring.size(); ++spring) {
      for (std::size_t i = rows.start[spring]; i < rows.start[spring + 1]; ++i) {
        result[kind * nodes_ + static_cast<std::size_t>(rows.share[i].node)] +=
            rows.share[i].weight * by_spring[spring];
      }
    }
  }
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] *= std::numbers::ln10 * std::pow(10.0, logarithms[i]);
  }
  return result;
}

SpringConstants SpringParameters::shares(std::size_t parameter) const {
  SpringConstants result;
  for (std::size_t kind = 0; kind < rows_.size(); ++kind) {
    const Rows& rows = rows_[kind];
    std::vector<double>& list = list_of(result, kind);
    list.assign(rows.start.size() - 1, 0.0);
    for (std::size_t spring = 0; spring < list.size() && parameter / nodes_ == kind; ++spring) {
      for (std::size_t i = rows.start[spring]; i < rows.start[spring + 1]; ++i) {
        const bool own = static_cast<std::size_t>(rows.share[i].node) == parameter % nodes_;
        list[spring] += own ? rows.share[i].weight : 0.0;
      }
    }
  }
  return result;
}

}  // namespace haptrial::deformable
