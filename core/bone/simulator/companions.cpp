#include "core/bone/simulator/companions.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace haptrial::bone {
namespace {

std::uint64_t ticks_of(double period, double rate) {
  return static_cast<std::uint64_t>(std::max(1.0, std::round(period * rate)));
}

/// The pieces that dust cannot pass, where they are published to be.
void list_bones(const BoneWorld& world, std::vector<DustBone>& bones) {
  const int count = world.pieces();
  bones.resize(static_cast<std::size_t>(count));
  world.published_poses().read(count, [&](int piece, const Eigen::Isometry3d& pose) {
    bones[static_cast<std::size_t>(piece)] = {&world.volume(piece), pose};
  });
}

DustBalance only_counted(double amount) {
  DustBalance balance;
  balance.deposited = balance.lying = amount;
  return balance;
}

}  // namespace

SteppedCompanions::SteppedCompanions(Simulator& simulator, const CompanionParameters& parameters,
                                     double rate, bool search)
    : simulator_(simulator),
      dust_every_(ticks_of(parameters.dust_period, rate)),
      search_every_(search ? ticks_of(parameters.search_period, rate) : 0) {
  if (parameters.dusty) {
    dust_.emplace(parameters.dust);
  }
}

void SteppedCompanions::after_tick(const Simulator& simulator, double dt) noexcept {
  for (const DustDeposit& deposit : simulator.deposits()) {
    counted_ += deposit.amount;
    if (dust_) {
      dust_->deposit(deposit);
    }
  }
  unstepped_ += dt;
  ++ticks_;
  if (dust_ && ticks_ % dust_every_ == 0) {
    dust_->place(simulator.dust_tools());
    step_dust(unstepped_);
  }
  if (search_every_ > 0 && ticks_ % search_every_ == 0) {
    simulator_.world().search();
  }
}

void SteppedCompanions::step_dust(double dt) {
  list_bones(simulator_.world(), bones_);
  dust_->follow(bones_);
  dust_->step(dt);
  unstepped_ = 0.0;
}

bool SteppedCompanions::quads(std::vector<DustQuad>& quads, std::uint64_t& version) const {
  if (!dust_ || version == dust_->version()) {
    return false;
  }
  version = dust_->version();
  dust_->quads(quads);
  return true;
}

DustBalance SteppedCompanions::dust() const {
  return dust_ ? dust_->balance() : only_counted(counted_);
}

void SteppedCompanions::settle() {
  if (dust_) {
    step_dust(unstepped_);
  }
}

ThreadedCompanions::ThreadedCompanions(Simulator& simulator, const CompanionParameters& parameters,
                                       bool search)
    : simulator_(simulator),
      search_period_(parameters.search_period) {
  if (parameters.dusty) {
    const auto bones = [&simulator](std::vector<DustBone>& list) {
      list_bones(std::as_const(simulator).world(), list);
    };
    dust_.emplace(parameters.dust, bones, parameters.dust_period);
  }
  if (search) {
    searcher_ = std::thread([this] { this->search(); });
  }
}

ThreadedCompanions::~ThreadedCompanions() {
  stop_.store(true, std::memory_order_relaxed);
  if (searcher_.joinable()) {
    searcher_.join();
  }
}

void ThreadedCompanions::after_tick(const Simulator& simulator, double) noexcept {
  double counted = counted_.load(std::memory_order_relaxed);
  for (const DustDeposit& deposit : simulator.deposits()) {
    counted += deposit.amount;
    if (dust_) {
      dust_->deposit(deposit);
    }
  }
  counted_.store(counted, std::memory_order_relaxed);
  if (dust_) {
    dust_->place(simulator.dust_tools());
  }
}

DustBalance ThreadedCompanions::dust() const {
  return dust_ ? dust_->balance() : only_counted(counted_.load(std::memory_order_relaxed));
}

void ThreadedCompanions::search() {
  const auto period = std::chrono::duration<double>(search_period_);
  while (!stop_.load(std::memory_order_relaxed)) {
    simulator_.world().search();
    std::this_thread::sleep_for(period);
  }
}

void ThreadedCompanions::settle() {
  if (dust_) {
    dust_->settle();
  }
}

}  // namespace haptrial::bone
