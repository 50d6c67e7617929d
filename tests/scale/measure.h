// SPDX-License-Identifier: MIT
// What rank 0 spends on reports and marks, measured on this machine with the program's own code.
#pragma once

namespace wholehand::scale {

// Prints the numbers that Machine has of them.
void measure();

}  // namespace wholehand::scale
