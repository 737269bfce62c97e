// The pipe of the exam of soft bodies for C++, without a library: vectors, a body's file, and the
// lines. A model derives from Model and its main() calls answer().
#pragma once

#include <array>
#include <cmath>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

struct V {
  double x{0}, y{0}, z{0};
};
inline V operator+(V a, V b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V operator-(V a, V b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V operator*(double s, V a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(V a, V b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V cross(V a, V b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A tetrahedron at rest. Its deformation gradient is F = sum of x_i b_i^T over its corners.
struct Tet {
  std::array<int, 4> corner{};
  std::array<V, 4> b{};   // gradients of the shape functions [1/m]
  double volume{0};       // [m³]
  double mu{0}, bulk{0};  // of W = mu/2 tr(F^T F) + bulk/2 (det F - 1 - mu/bulk)² [Pa]
};

struct Body {
  std::vector<V> rest, force;  // [m], [N] at a load of 1
  std::vector<int> marker;     // 1: fixed, 2: held by the tool
  std::vector<double> mass;    // [kg]
  std::vector<Tet> tets;
  double period{1e-3};  // of a tick [s]
};

/// F by columns, and the derivative of det F by F, likewise.
struct Gradient {
  std::array<V, 3> f{}, cofactor{};
  double det{0};
};
inline Gradient gradient(const Tet& t, const std::vector<V>& x) {
  Gradient g;
  for (int i = 0; i < 4; ++i) {
    const V p = x[t.corner[i]];
    g.f[0] = g.f[0] + t.b[i].x * p;
    g.f[1] = g.f[1] + t.b[i].y * p;
    g.f[2] = g.f[2] + t.b[i].z * p;
  }
  g.cofactor = {cross(g.f[1], g.f[2]), cross(g.f[2], g.f[0]), cross(g.f[0], g.f[1])};
  g.det = dot(g.f[0], g.cofactor[0]);
  return g;
}
/// A matrix by columns times a vector.
inline V times(const std::array<V, 3>& m, V b) { return b.x * m[0] + b.y * m[1] + b.z * m[2]; }

/// The material's force on a corner of a tetrahedron [N].
inline V elastic_force(const Tet& t, int corner, const Gradient& g) {
  const double pressure = t.bulk * (g.det - 1) - t.mu;
  return -t.volume * (t.mu * times(g.f, t.b[corner]) + pressure * times(g.cofactor, t.b[corner]));
}
/// The sum of these on the vertices that the tool holds.
inline V force_on_tool(const Body& body, const std::vector<V>& x) {
  V force;
  for (const Tet& t : body.tets) {
    for (int i = 0; i < 4; ++i) {
      if (body.marker[t.corner[i]] == 2) {
        force = force + elastic_force(t, i, gradient(t, x));
      }
    }
  }
  return force;
}

inline Body read_body(const std::string& node_file, double rate) {
  Body body;
  body.period = 1.0 / rate;
  std::ifstream nodes(node_file), elements(node_file.substr(0, node_file.size() - 4) + "ele");
  std::string line;
  std::size_t count = 0, number = 0;
  std::getline(nodes, line);
  std::istringstream(line) >> count;
  body.rest.resize(count), body.force.resize(count), body.marker.resize(count);
  body.mass.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    V &p = body.rest[i], &f = body.force[i];
    nodes >> number >> p.x >> p.y >> p.z >> f.x >> f.y >> f.z >> body.marker[i];
  }
  std::getline(elements, line);
  std::istringstream(line) >> count;
  body.tets.resize(count);
  for (Tet& t : body.tets) {
    double young = 0, poisson = 0, density = 0;
    elements >> number >> t.corner[0] >> t.corner[1] >> t.corner[2] >> t.corner[3] >> young >>
        poisson >> density;
    const V o = body.rest[t.corner[0]];
    const V a = body.rest[t.corner[1]] - o, b = body.rest[t.corner[2]] - o,
            c = body.rest[t.corner[3]] - o;
    const double six = dot(a, cross(b, c));
    t.volume = six / 6;
    t.b = {V{}, (1 / six) * cross(b, c), (1 / six) * cross(c, a), (1 / six) * cross(a, b)};
    t.b[0] = -1.0 * (t.b[1] + t.b[2] + t.b[3]);
    t.mu = young / (2 * (1 + poisson));
    t.bulk = young * poisson / ((1 + poisson) * (1 - 2 * poisson)) + t.mu;
    for (const int v : t.corner) {
      body.mass[v] += density * t.volume / 4;
    }
  }
  return body;
}

class Model {
 public:
  virtual ~Model() = default;
  virtual void begin(Body body) {
    body_ = std::move(body);
    start();
  }
  virtual void start() {
    x_ = body_.rest;
    v_.assign(x_.size(), V{});
  }
  /// One tick. @param tool  how far the vertices that it holds are moved @returns force on the tool
  virtual V tick(V tool, double load) = 0;

  const Body& body() const { return body_; }
  const std::vector<V>& places() const { return x_; }

 protected:
  Body body_;
  std::vector<V> x_, v_;  // places and velocities of the vertices
};

/// Answers the lines of haptrial exam run until they end.
inline int answer(Model& model) {
  std::ios::sync_with_stdio(false);
  std::cout.precision(9);
  V first;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string word, more;
    words >> word;
    if (word == "body") {  // body soft rate HZ FILE
      double rate = 0;
      words >> more >> more >> rate >> std::ws;
      std::getline(words, more);
      model.begin(read_body(more, rate));
      std::cout << "ready\n";
    } else if (word == "start") {  // start X Y Z
      words >> first.x >> first.y >> first.z;
      model.start();
      std::cout << "ready\n";
    } else if (word == "tick") {  // tick TIME X Y Z LOAD
      double time = 0, load = 0;
      V tool;
      words >> time >> tool.x >> tool.y >> tool.z >> load;
      const V force = model.tick(tool - first, load);
      std::cout << force.x << ' ' << force.y << ' ' << force.z << '\n';
    } else {  // shape
      for (std::size_t i = 0; i < model.places().size(); ++i) {
        const V u = model.places()[i] - model.body().rest[i];
        std::cout << u.x << ' ' << u.y << ' ' << u.z << ' ';
      }
      std::cout << '\n';
    }
    std::cout.flush();
  }
  return 0;
}
