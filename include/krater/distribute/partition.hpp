// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file distribute/partition.hpp
/// Which rank has a block. Space is cut by recursive coordinate bisection of the weighted centres
/// of blocks (Zoltan's RCB, Boman et al., Scientific Programming 20, 2012). Every rank knows all
/// weights and makes the same cuts for itself, so that no message is needed, and a block which
/// comes later has an owner without a question asked. A cut moves little when weights do.
#include <memory>
#include <vector>

#include "krater/grid/key_index.hpp"

namespace krater {

class Partition {
 public:
  explicit Partition(int dimension);
  ~Partition();
  Partition(const Partition&) = delete;
  Partition& operator=(const Partition&) = delete;

  struct Weighted {
    BlockKey key;
    double weight;
  };
  /// Cut anew; every rank gives the same blocks.
  void cut(const std::vector<Weighted>& blocks);
  /// Of any block, by the last cut.
  int owner(const BlockKey& key) const;
  /// It is a test that wants cuts often, whether they are needed or not (KRATER_DEAL=scattered).
  bool restless() const;

 private:
  struct Cuts;
  std::unique_ptr<Cuts> cuts_;
};

}  // namespace krater
