// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Places on the product, as commands take them.
import { Vector3 } from "three";

/// "12.3,-4.5,60.0"
export function placeText(place: Vector3): string {
  return [place.x, place.y, place.z].map((x) => x.toFixed(1)).join(",");
}

/// The same for reading.
export function placeWords(place: Vector3): string {
  return placeText(place).replace(/,/g, ", ");
}

/// Puts "--at x,y,z" where it can be pasted from, and says so.
export function copyPlace(section: HTMLElement, place: Vector3): void {
  const option = `--at ${placeText(place)}`;
  void navigator.clipboard?.writeText(option);
  const line = section.querySelector<HTMLElement>(".view-copied");
  if (!line) return;
  line.querySelector("code")!.textContent = option;
  line.hidden = false;
}
