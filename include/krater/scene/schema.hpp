// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
/// \file scene/schema.hpp
/// The declarations of scenes as a JSON schema (draft 7), for editors and for the manual's
/// reference. Reference: json-schema.org, draft-07; yaml-language-server reads it. Assumption: it
/// judges keys, forms and words; units and rules between keys are krater check's.
#include <string>

namespace krater {

/// Of a scene, or of a loading path (`krater point`). Beside each key's schema stand `x-takes` (its
/// forms in words) and `x-default`.
std::string schema_text(bool loading_path);

}  // namespace krater
