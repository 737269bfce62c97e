// CHAI3D's finger proxy sits the exam: a program for `haptrial exam run EXAM --program`.
// It needs a CHAI3D of your own (3.2 or newer); nothing of it is part of haptrial. The proxy's
// radius is 10 micrometres, since the exam's tool is a point.
//
//   c++ -O2 -std=c++17 -I CHAI3D/src -I CHAI3D/externals/Eigen chai3d_candidate.cpp -lchai3d -o
//   chai3d

#include <chai3d.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

namespace {

constexpr double kRadius = 1e-5;  // [m]

class Candidate {
 public:
  void begin(const std::string& file, double stiffness, double friction) {
    world_ = std::make_unique<chai3d::cWorld>();
    mesh_ = new chai3d::cMesh();  // the world deletes it
    read(file);
    mesh_->m_material->setStiffness(stiffness);
    mesh_->m_material->setUseHapticFriction(friction > 0.0);
    mesh_->m_material->setStaticFriction(friction);
    mesh_->m_material->setDynamicFriction(friction);
    mesh_->createAABBCollisionDetector(kRadius);
    world_->addChild(mesh_);
    world_->computeGlobalPositions(true);
  }
  void start(const chai3d::cVector3d& tool) {
    proxy_ = std::make_unique<chai3d::cAlgorithmFingerProxy>();
    proxy_->initialize(world_.get(), tool);
    proxy_->setProxyRadius(kRadius);
  }
  chai3d::cVector3d tick(const chai3d::cVector3d& tool) {
    return proxy_->computeForces(tool, chai3d::cVector3d(0.0, 0.0, 0.0));
  }

 private:
  /// Vertices and triangles are all that the exam's bodies have.
  void read(const std::string& file) {
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string what;
      words >> what;
      if (what == "v") {
        double x = 0.0, y = 0.0, z = 0.0;
        words >> x >> y >> z;
        mesh_->newVertex(x, y, z);
      } else if (what == "f") {
        unsigned a = 0, b = 0, c = 0;
        words >> a >> b >> c;
        mesh_->newTriangle(a - 1, b - 1, c - 1);
      }
    }
  }

  std::unique_ptr<chai3d::cWorld> world_;
  chai3d::cMesh* mesh_ = nullptr;
  std::unique_ptr<chai3d::cAlgorithmFingerProxy> proxy_;
};

chai3d::cVector3d place_of(std::istringstream& words) {
  double x = 0.0, y = 0.0, z = 0.0;
  words >> x >> y >> z;
  return chai3d::cVector3d(x, y, z);
}

}  // namespace

int main() {
  Candidate candidate;
  std::cout.precision(17);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string what, file, name;
    words >> what;
    if (what == "body") {
      double stiffness = 0.0, friction = 0.0, rate = 0.0;
      words >> name >> stiffness >> name >> friction >> name >> rate >> std::ws;
      std::getline(words, file);
      candidate.begin(file, stiffness, friction);
      std::cout << "ready" << std::endl;
    } else if (what == "start") {
      candidate.start(place_of(words));
      std::cout << "ready" << std::endl;
    } else if (what == "tick") {
      double time = 0.0;
      words >> time;
      const chai3d::cVector3d force = candidate.tick(place_of(words));
      std::cout << force(0) << ' ' << force(1) << ' ' << force(2) << std::endl;
    }
  }
}
