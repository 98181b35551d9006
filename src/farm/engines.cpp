#include "farm/engines.h"

#include <array>

namespace vdbeam {

std::span<const FarmEngine> farm_engines() {
  static constexpr std::array<FarmEngine, 2> table{{
      {"slurm", "An sbatch script: an array over the frames", slurm_script, slurm_submission},
      {"openjd", "An Open Job Description 2023-09 template, e.g. for AWS Deadline Cloud",
       openjd_template, openjd_submission},
  }};
  return table;
}

} // namespace vdbeam
