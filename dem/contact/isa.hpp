#pragma once
// The instruction set of the contact forces (dem/contact/forces/), chosen when the program runs: the widest one that
// the program was built with and the processor has, unless another is pinned. A run has the same bits with each of
// them: every operation is elementwise and exactly rounded, and sums go by fours of contacts whatever the lanes.
#include <string>
#include <vector>

namespace dem {

/// The instruction sets that the program has and the processor runs, the least first.
std::vector<std::string> isas();

/// The instruction set in use. Throws InputError (69) where there is none.
std::string isa();

/// Takes this instruction set from now on; call it before threads start. Throws InputError (69) when it is not among
/// isas().
void pin_isa(const std::string& name);

}  // namespace dem
