// Position-based dynamics that sits the exam of soft bodies: two constraints a tetrahedron, of its
// form and of its volume, with the material's compliance (XPBD), once in each of ten small steps.
// After: M. Macklin, M. Müller, A constraint-based formulation of stable neo-Hookean materials,
// 2021.
//
//     c++ -O2 -o pbd_body docs/worked/exam/pbd_body.cpp
//     haptrial exam run out/exam-soft --out out/answers-pbd --program ./pbd_body
#include "soft_pipe.h"

class PbdBody final : public Model {
 public:
  V tick(V tool, double load) override {
    constexpr int kSteps = 10;
    const V from = last_;
    last_ = tool;
    for (int i = 1; i <= kSteps; ++i) {
      step(from + (double(i) / kSteps) * (tool - from), load, body_.period / kSteps);
    }
    return force_on_tool(body_, x_);
  }
  void start() override {
    Model::start();
    last_ = {};
  }

 private:
  void step(V tool, double load, double h) {
    const std::vector<V> before = x_;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (body_.marker[i] == 0) {
        x_[i] = x_[i] + h * v_[i] + (h * h * load / body_.mass[i]) * body_.force[i];
      } else if (body_.marker[i] == 2) {
        x_[i] = body_.rest[i] + tool;
      }
    }
    for (const Tet& t : body_.tets) {
      keep_form(t, h);
      keep_volume(t, h);
    }
    for (std::size_t i = 0; i < x_.size(); ++i) {
      v_[i] = (1 / h) * (x_[i] - before[i]);
    }
  }

  /// The energy mu/2 tr(F^T F) as a constraint, the root of the trace.
  void keep_form(const Tet& t, double h) {
    const Gradient g = gradient(t, x_);
    const double size = std::sqrt(dot(g.f[0], g.f[0]) + dot(g.f[1], g.f[1]) + dot(g.f[2], g.f[2]));
    std::array<V, 4> slope;
    for (int i = 0; i < 4; ++i) {
      slope[i] = (1 / size) * times(g.f, t.b[i]);
    }
    correct(t, size, slope, 1 / (t.mu * t.volume), h);
  }
  void keep_volume(const Tet& t, double h) {
    const Gradient g = gradient(t, x_);
    std::array<V, 4> slope;
    for (int i = 0; i < 4; ++i) {
      slope[i] = times(g.cofactor, t.b[i]);
    }
    correct(t, g.det - 1 - t.mu / t.bulk, slope, 1 / (t.bulk * t.volume), h);
  }
  void correct(const Tet& t, double value, const std::array<V, 4>& slope, double compliance,
               double h) {
    double sum = compliance / (h * h);
    for (int i = 0; i < 4; ++i) {
      sum += weight(t.corner[i]) * dot(slope[i], slope[i]);
    }
    const double lambda = -value / sum;
    for (int i = 0; i < 4; ++i) {
      const int v = t.corner[i];
      x_[v] = x_[v] + weight(v) * lambda * slope[i];
    }
  }
  double weight(int v) const { return body_.marker[v] == 0 ? 1 / body_.mass[v] : 0.0; }

  V last_;  // displacement of the tool
};

int main() {
  PbdBody body;
  return answer(body);
}
