// SPDX-License-Identifier: GPL-3.0-or-later
#include <mpi.h>
#include <trilinos/zoltan.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "krater/core/errors.hpp"
#include "krater/core/ranks.hpp"
#include "krater/distribute/partition.hpp"

namespace krater {

/// Zoltan asks for the blocks by callbacks, and keeps the cuts.
struct Partition::Cuts {
  int dimension;
  bool scattered;    ///< a test: every block anywhere, elsewhere after each cut
  int shuffles = 0;  ///< cuts of such a test so far
  Zoltan_Struct* zoltan = nullptr;
  const std::vector<Weighted>* blocks = nullptr;

  explicit Cuts(int d) : dimension{d} {
    const char* deal = std::getenv("KRATER_DEAL");
    scattered = deal != nullptr && std::string{deal} == "scattered";
  }
  void begin() {
    if (zoltan != nullptr) return;
    float version = 0;
    if (Zoltan_Initialize(0, nullptr, &version) != ZOLTAN_OK)
      throw NumericalError("Zoltan does not start");
    zoltan = Zoltan_Create(MPI_COMM_SELF);
    const std::string parts = std::to_string(ranks::count());
    for (const auto& [name, value] :
         {std::pair{"DEBUG_LEVEL", "0"}, std::pair{"NUM_GLOBAL_PARTS", parts.c_str()},
          std::pair{"LB_METHOD", "RCB"}, std::pair{"KEEP_CUTS", "1"}, std::pair{"RCB_REUSE", "1"},
          std::pair{"OBJ_WEIGHT_DIM", "1"}, std::pair{"NUM_GID_ENTRIES", "1"},
          std::pair{"NUM_LID_ENTRIES", "1"}, std::pair{"RETURN_LISTS", "NONE"},
          std::pair{"RCB_RECTILINEAR_BLOCKS", "0"}})
      Zoltan_Set_Param(zoltan, name, value);
    Zoltan_Set_Num_Obj_Fn(zoltan, count_blocks, this);
    Zoltan_Set_Obj_List_Fn(zoltan, list_blocks, this);
    Zoltan_Set_Num_Geom_Fn(zoltan, count_axes, this);
    Zoltan_Set_Geom_Fn(zoltan, place_block, this);
  }
  ~Cuts() {
    if (zoltan != nullptr) Zoltan_Destroy(&zoltan);
  }
  Cuts(const Cuts&) = delete;
  Cuts& operator=(const Cuts&) = delete;

  /// Of a block, in blocks of the coarsest level.
  static void centre(const BlockKey& key, int dimension, double* place) {
    for (int a = 0; a < dimension; ++a)
      place[a] = std::ldexp(key.i[static_cast<std::size_t>(a)] + 0.5, -key.level);
  }
  static const Cuts& of(void* data) { return *static_cast<const Cuts*>(data); }
  static int count_blocks(void* data, int* error) {
    *error = ZOLTAN_OK;
    return static_cast<int>(of(data).blocks->size());
  }
  static void list_blocks(void* data, int, int, ZOLTAN_ID_PTR, ZOLTAN_ID_PTR local, int,
                          float* weights, int* error) {
    const auto& blocks = *of(data).blocks;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      local[b] = static_cast<ZOLTAN_ID_TYPE>(b);
      weights[b] = static_cast<float>(blocks[b].weight);
    }
    *error = ZOLTAN_OK;
  }
  static int count_axes(void* data, int* error) {
    *error = ZOLTAN_OK;
    return of(data).dimension;
  }
  static void place_block(void* data, int, int, ZOLTAN_ID_PTR, ZOLTAN_ID_PTR local, double* place,
                          int* error) {
    const BlockKey& key = (*of(data).blocks)[*local].key;
    centre(key, of(data).dimension, place);
    *error = ZOLTAN_OK;
  }
};

Partition::Partition(int dimension) : cuts_{std::make_unique<Cuts>(dimension)} {}
Partition::~Partition() = default;

void Partition::cut(const std::vector<Weighted>& blocks) {
  if (cuts_->scattered) {
    ++cuts_->shuffles;
    return;
  }
  cuts_->begin();
  cuts_->blocks = &blocks;
  int changes = 0, wide_global = 0, wide_local = 0, imports = 0, exports = 0;
  ZOLTAN_ID_PTR import_global = nullptr, import_local = nullptr, export_global = nullptr,
                export_local = nullptr;
  int *import_ranks = nullptr, *import_parts = nullptr, *export_ranks = nullptr,
      *export_parts = nullptr;
  const int status =
      Zoltan_LB_Partition(cuts_->zoltan, &changes, &wide_global, &wide_local, &imports,
                          &import_global, &import_local, &import_ranks, &import_parts, &exports,
                          &export_global, &export_local, &export_ranks, &export_parts);
  cuts_->blocks = nullptr;
  if (status != ZOLTAN_OK && status != ZOLTAN_WARN)
    throw NumericalError("the blocks could not be dealt out among the ranks (Zoltan)");
}

bool Partition::restless() const { return cuts_->scattered; }

int Partition::owner(const BlockKey& key) const {
  if (cuts_->scattered)
    return static_cast<int>(hash_of(key, cuts_->shuffles) %
                            static_cast<std::size_t>(ranks::count()));
  double place[3] = {};
  Cuts::centre(key, cuts_->dimension, place);
  int rank = 0, part = 0;
  if (Zoltan_LB_Point_PP_Assign(cuts_->zoltan, place, &rank, &part) != ZOLTAN_OK)
    throw NumericalError("a block has no rank (Zoltan)");
  return part;
}

}  // namespace krater
