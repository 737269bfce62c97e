// Vertex block descent that sits the exam of soft bodies: a backward Euler step whose energy each
// vertex in turn lessens by Newton's method with its own 3 x 3 block.
// After: A. H. Chen, Z. Liu, Y. Yang, C. Yuksel, Vertex block descent, 2024.
//
//     c++ -O2 -o vbd_body docs/worked/exam/vbd_body.cpp
//     haptrial exam run out/exam-soft --out out/answers-vbd --program ./vbd_body 10
#include <cstdlib>

#include "soft_pipe.h"

class VbdBody final : public Model {
 public:
  explicit VbdBody(int sweeps) : sweeps_(sweeps) {}

  void begin(Body body) override {
    Model::begin(std::move(body));
    around_.assign(x_.size(), {});
    for (const Tet& t : body_.tets) {
      for (int i = 0; i < 4; ++i) {
        around_[t.corner[i]].push_back({&t, i});
      }
    }
  }
  V tick(V tool, double load) override {
    const double h = body_.period;
    const std::vector<V> before = x_;
    std::vector<V> free = x_;  // where inertia and forces alone take the vertices
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (body_.marker[i] == 0) {
        free[i] = x_[i] + h * v_[i] + (h * h * load / body_.mass[i]) * body_.force[i];
        x_[i] = free[i];
      } else if (body_.marker[i] == 2) {
        x_[i] = body_.rest[i] + tool;
      }
    }
    for (int sweep = 0; sweep < sweeps_; ++sweep) {
      for (std::size_t i = 0; i < x_.size(); ++i) {
        if (body_.marker[i] == 0) {
          descend(i, free[i], h);
        }
      }
    }
    for (std::size_t i = 0; i < x_.size(); ++i) {
      v_[i] = (1 / h) * (x_[i] - before[i]);
    }
    return force_on_tool(body_, x_);
  }

 private:
  using Block = std::array<V, 3>;  // by columns
  struct Corner {
    const Tet* tet;
    int at;
  };

  /// The vertex's step to the least energy as its block sees it. The volume is linear in each
  /// vertex, so that the block is positive definite.
  void descend(std::size_t i, V free, double h) {
    const double inertia = body_.mass[i] / (h * h);
    Block block{V{inertia, 0, 0}, V{0, inertia, 0}, V{0, 0, inertia}};
    V force = inertia * (free - x_[i]);
    for (const Corner& c : around_[i]) {
      const Tet& t = *c.tet;
      const V b = t.b[c.at];
      const Gradient g = gradient(t, x_);
      force = force + elastic_force(t, c.at, g);
      const V volume = times(g.cofactor, b);
      const double form = t.volume * t.mu * dot(b, b), k = t.volume * t.bulk;
      block[0] = block[0] + V{form, 0, 0} + k * volume.x * volume;
      block[1] = block[1] + V{0, form, 0} + k * volume.y * volume;
      block[2] = block[2] + V{0, 0, form} + k * volume.z * volume;
    }
    const double det = dot(block[0], cross(block[1], block[2]));  // Cramer's rule
    x_[i] = x_[i] + (1 / det) * V{dot(force, cross(block[1], block[2])),
                                  dot(block[0], cross(force, block[2])),
                                  dot(block[0], cross(block[1], force))};
  }

  int sweeps_;
  std::vector<std::vector<Corner>> around_;  // tetrahedra of each vertex
};

int main(int count, char** words) {
  VbdBody body(count > 1 ? std::atoi(words[1]) : 10);
  return answer(body);
}
