#pragma once
/// All that a command's .cpp needs of the grammar.

#include "cli/command.h"      // IWYU pragma: export
#include "cli/main.h"         // IWYU pragma: export
#include "cli/match.h"        // IWYU pragma: export
#include "cli/output_name.h"  // IWYU pragma: export
#include "cli/session.h"      // IWYU pragma: export
