// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/declarations/declarations.hpp
/// The declarations of all blocks of a scene and of a loading path. The readers of readers/ read by
/// them; the schema is written from them.
#include "scene/yaml/declaration.hpp"

namespace krater::scene {

const BlockInfo& scene_block();        ///< the file of a scene
const BlockInfo& point_scene_block();  ///< the file of `krater point`
const BlockInfo& nothing_block();      ///< of what takes no options

const BlockInfo& grid_block();
const BlockInfo& box_block();
const BlockInfo& boundary_block();
const BlockInfo& side_block();         ///< the condition of a side
const BlockInfo& driven_side_block();  ///< a moving side with friction
const BlockInfo& refine_block();       ///< a rule of `refine`
const BlockInfo& refine_where_block();
const BlockInfo& bounds_block();  ///< z_min: ..., of regions
const BlockInfo& corners_block();

const BlockInfo& time_block();
const BlockInfo& stop_block();
const BlockInfo& perforated_block();
const BlockInfo& method_block();
const BlockInfo& transfer_block();
const BlockInfo& method_reference_block();
const BlockInfo& output_block();
const BlockInfo& contact_block();
const BlockInfo& contact_pair_block();

const BlockInfo& material_block();
const BlockInfo& generated_card_block();
const BlockInfo& keyword_card_block();
const BlockInfo& law_block(int law);  ///< the parameters of a law of the catalogue
const BlockInfo& damage_block();
const BlockInfo& failure_block();
const BlockInfo& spall_block();

const BlockInfo& body_block();
const BlockInfo& points_block();
const BlockInfo& zone_block();
const BlockInfo& speed_block();
const BlockInfo& turn_block();
const BlockInfo& rigid_block();
const BlockInfo& kinematics_block();
const BlockInfo& lagrangian_mesh_block();
const BlockInfo& hourglass_block();
const BlockInfo& element_failure_block();
const BlockInfo& element_limits_block();
const BlockInfo& body_reference_block();
const BlockInfo& sph_block();

const BlockInfo& shape_block();
const BlockInfo& repair_block();

const BlockInfo& loads_block();
const BlockInfo& load_block();
const BlockInfo& damping_block();
const BlockInfo& time_table_block();
const BlockInfo& detonator_block();
const BlockInfo& detonator_plane_block();

const BlockInfo& measure_block();
const BlockInfo& measure_at_block();
const BlockInfo& measure_within_block();
const BlockInfo& references_block();
const BlockInfo& reference_block();
const BlockInfo& outcome_block();
const BlockInfo& gauge_block();
const BlockInfo& filter_block();

const BlockInfo& point_block();
const BlockInfo& path_block();
const BlockInfo& even_block();  ///< values from, to, count

/// A number with that unit, an expression in t, or a table of time.
std::vector<Form> function_of_time(const char* unit);
/// Names of everything that can be measured or written.
std::vector<std::string> field_names();

}  // namespace krater::scene
