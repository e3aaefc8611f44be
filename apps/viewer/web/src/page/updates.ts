// SPDX-License-Identifier: Apache-2.0
import type { Editor } from "../tools/editor";
import type { SliceView } from "../view/slice_view";
import type { Hints } from "./hints";
import type { Keepers } from "./keepers";
import type { Models } from "./models";
import type { Server } from "./server";
import type { Stage } from "./stage";

export interface UpdateParts {
  models: Models;
  server: Server;
  editor: Editor;
  stage: Stage;
  keepers: Keepers;
  hints: Hints;
}

/** From now on each part of the page follows the changes of those that it shows or keeps. */
export function connectUpdates(parts: UpdateParts): void {
  followTime(parts);
  updateViews(parts);
  updateSurface(parts);
  updateHints(parts);
  updateKeepers(parts);
}

/** First: all others look up what is of the time that is seen. */
function followTime({ models, server }: UpdateParts): void {
  const { navigation, project } = models;
  navigation.on(["time"], () => {
    project.setTime(navigation.time, navigation.ownTime);
    server.http.time = project.timeOfNew;
  });
}

function updateViews({ models, editor, stage }: UpdateParts): void {
  const { navigation, project, appearance, second } = models;
  const each = (act: (view: SliceView) => void) => () => stage.views.forEach(act);
  const paint = each((view) => view.paint());
  const refresh = each((view) => view.refresh(true));
  navigation.on(["planes", "window"], refresh);
  navigation.on(["time"], refresh);
  project.on(
    ["contours", "structures"],
    each((view) => view.contoursChanged()),
  );
  project.on(
    ["surfaces"],
    each((view) => view.surfacesChanged()),
  );
  project.on(["time"], paint);
  project.on(["selection"], paint);
  project.on(
    ["draft"],
    each((view) => view.draftChanged()),
  );
  appearance.on(["changed"], paint);
  second.on(
    ["image", "shown", "look"],
    each((view) => view.secondChanged()),
  );
  second.on(["image", "shown"], () => editor.drawing.setImage(second.front));
  editor.on(["tool", "hover"], paint);
  editor.measuring.measurements.on(["changed"], paint);
  editor.points.on(["points"], paint);
  editor.drawing.on(["sketch"], paint);
  editor.proposals.on(["proposal"], paint);
  editor.rulePreview.on(["preview"], paint);
}

function updateSurface({ models, editor, stage }: UpdateParts): void {
  const { navigation, project, theme, opacities } = models;
  const { surface } = stage;
  navigation.on(["planes"], () => surface.planesChanged());
  project.on(["contours", "structures", "selection", "time"], () => surface.contoursChanged());
  project.on(["structures"], () => surface.restyle());
  project.on(["surfaces", "time"], () => surface.surfacesChanged());
  project.on(["motions"], () => surface.motionsChanged());
  theme.on(["changed"], () => surface.themeChanged());
  opacities.on(["changed"], () => surface.restyle());
  editor.points.on(["points"], () => surface.pointsChanged());
}

function updateHints({ models, editor, hints }: UpdateParts): void {
  const tell = () => hints.tell();
  models.project.on(["selection"], tell);
  models.project.on(["contours"], () => hints.edited());
  editor.on(["tool", "hover"], tell);
  editor.points.on(["points"], tell);
  editor.drawing.on(["sketch"], tell);
  editor.proposals.on(["proposal"], tell);
}

function updateKeepers({ models, server, editor, keepers }: UpdateParts): void {
  const saveSoon = () => keepers.page.saveSoon();
  models.navigation.on(["layout"], () => keepers.arrangement.keepSoon());
  models.navigation.on(["planes", "window", "layout"], saveSoon);
  models.sizes.on(["changed"], () => keepers.arrangement.keepSoon());
  models.sizes.on(["changed"], saveSoon);
  models.project.on(["structures"], saveSoon);
  models.appearance.on(["changed"], saveSoon);
  models.opacities.on(["changed"], saveSoon);
  models.second.on(["shown", "look"], saveSoon);
  editor.measuring.measurements.on(["changed"], saveSoon);
  editor.drawing.on(["points"], saveSoon);
  editor.drawing.on(["points"], () => server.saving.tell());
}
