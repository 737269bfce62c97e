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

bool changed_quads(const std::optional<Dust>& flow, std::vector<DustQuad>& quads,
                   std::uint64_t& version) {
  if (!flow || version == flow->version()) {
    return false;
  }
  version = flow->version();
  flow->quads(quads);
  return true;
}

DustBalance only_counted(double amount) {
  DustBalance balance;
  balance.deposited = balance.lying = amount;
  return balance;
}

}  // namespace

DustParameters blood_parameters() {
  DustParameters p;
  p.bulking = 1.0;
  p.slope = kLeastSlope;
  p.suction_rate = 5e-6;
  p.suction_reach = 3e-3;
  return p;
}

SteppedCompanions::SteppedCompanions(Simulator& simulator, const CompanionParameters& parameters,
                                     double rate, bool search)
    : simulator_(simulator),
      dust_every_(ticks_of(parameters.dust_period, rate)),
      search_every_(search ? ticks_of(parameters.search_period, rate) : 0) {
  if (parameters.dusty) {
    dust_.emplace(parameters.dust);
  }
  if (parameters.bleeds) {
    blood_.emplace(parameters.blood);
  }
}

void SteppedCompanions::after_tick(const Simulator& simulator, double dt) noexcept {
  for (const DustDeposit& deposit : simulator.deposits()) {
    counted_ += deposit.amount;
    if (dust_) {
      dust_->deposit(deposit);
    }
  }
  if (blood_) {
    for (const DustDeposit& deposit : simulator.bleeding().deposits()) {
      blood_->deposit(deposit);
    }
  }
  unstepped_ += dt;
  ++ticks_;
  if ((dust_ || blood_) && ticks_ % dust_every_ == 0) {
    for (std::optional<Dust>* flow : {&dust_, &blood_}) {
      if (*flow) {
        (*flow)->place(simulator.dust_tools());
      }
    }
    step_flows(unstepped_);
  }
  if (search_every_ > 0 && ticks_ % search_every_ == 0) {
    simulator_.world().search();
  }
}

void SteppedCompanions::step_flows(double dt) {
  list_bones(simulator_.world(), bones_);
  for (std::optional<Dust>* flow : {&dust_, &blood_}) {
    if (*flow) {
      (*flow)->follow(bones_);
      (*flow)->step(dt);
    }
  }
  unstepped_ = 0.0;
}

bool SteppedCompanions::quads(std::vector<DustQuad>& quads, std::uint64_t& version) const {
  return changed_quads(dust_, quads, version);
}

bool SteppedCompanions::blood_quads(std::vector<DustQuad>& quads, std::uint64_t& version) const {
  return changed_quads(blood_, quads, version);
}

DustBalance SteppedCompanions::blood() const { return blood_ ? blood_->balance() : DustBalance{}; }

DustBalance SteppedCompanions::dust() const {
  return dust_ ? dust_->balance() : only_counted(counted_);
}

void SteppedCompanions::settle() { step_flows(unstepped_); }

ThreadedCompanions::ThreadedCompanions(Simulator& simulator, const CompanionParameters& parameters,
                                       bool search)
    : simulator_(simulator), search_period_(parameters.search_period) {
  const auto bones = [&simulator](std::vector<DustBone>& list) {
    list_bones(std::as_const(simulator).world(), list);
  };
  if (parameters.bleeds) {
    blood_.emplace(parameters.blood, bones, parameters.dust_period);
  }
  if (parameters.dusty) {
    dust_.emplace(parameters.dust, bones, parameters.dust_period);
  }
  if (search) {
    searcher_ = std::jthread([this](const std::stop_token& stop) { this->search(stop); });
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
  if (blood_) {
    for (const DustDeposit& deposit : simulator.bleeding().deposits()) {
      blood_->deposit(deposit);
    }
    blood_->place(simulator.dust_tools());
  }
}

DustBalance ThreadedCompanions::blood() const { return blood_ ? blood_->balance() : DustBalance{}; }

DustBalance ThreadedCompanions::dust() const {
  return dust_ ? dust_->balance() : only_counted(counted_.load(std::memory_order_relaxed));
}

void ThreadedCompanions::search(const std::stop_token& stop) {
  const auto period = std::chrono::duration<double>(search_period_);
  while (!stop.stop_requested()) {
    simulator_.world().search();
    std::this_thread::sleep_for(period);
  }
}

void ThreadedCompanions::settle() {
  for (std::optional<DustWorker>* flow : {&dust_, &blood_}) {
    if (*flow) {
      (*flow)->settle();
    }
  }
}

}  // namespace haptrial::bone
