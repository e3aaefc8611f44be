// SPDX-License-Identifier: Apache-2.0
#include "viewer/images/project_image.h"

#include "kontur/image/intensities.h"
#include "viewer/images/further_image.h"

namespace kontur::viewer {

ProjectImage::ProjectImage(OpenedImage opened)
    : voxels(std::move(opened.image)),
      frame_step_s(opened.times.step_s),
      cycle_frames(opened.times.cycle_frames),
      times(voxels, std::move(opened.times)),
      title(std::move(opened.title)),
      frame_of_reference_uid(std::move(opened.frame_of_reference_uid)),
      series(std::move(opened.series)),
      identity(std::move(opened.identity)),
      presets(window_presets(*voxels)),
      window(suggest_window(*voxels)),
      range(value_range(*voxels)),
      shows_borders(range.first < range.second && !is_label_map(*voxels)),
      unit(unit_of(identity, *voxels)) {}

}  // namespace kontur::viewer
