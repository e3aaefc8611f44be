// SPDX-License-Identifier: Apache-2.0

type Pointer = Pick<PointerEvent, "pointerId" | "pointerType"> & { isPrimary?: boolean };

/** Which pointer works on the views: one at a time, so that nothing else that touches the screen ends or bends a line, and no hand that rests beside a pen. */
export class Pointers {
  private holder: { pointer: Pointer; leave: () => void } | null = null;
  private knowsPen = false;
  private saidSo = false;

  /** `tellOfPen` is called once: when the first touch is not taken because of a pen. */
  constructor(private readonly tellOfPen: () => void) {}

  /** Whether the pointer may begin something. `leave` gives that up where a pen comes after its hand. */
  take(pointer: Pointer, leave: () => void): boolean {
    if (this.isPalm(pointer)) {
      if (!this.saidSo) this.tellOfPen();
      this.saidSo = true;
      return false;
    }
    const isPalmBelow = pointer.pointerType === "pen" && this.holder?.pointer.pointerType === "touch";
    if (this.isOther(pointer) && !isPalmBelow && !this.isStale(pointer)) return false;
    this.holder?.leave();
    this.holder = { pointer, leave };
    return true;
  }

  holds({ pointerId }: Pointer): boolean {
    return this.holder?.pointer.pointerId === pointerId;
  }

  release(): void {
    this.holder = null;
  }

  /** Whether its moves and presses mean nothing: another pointer works, or it is the hand that holds the pen. */
  ignores(pointer: Pointer): boolean {
    return this.isPalm(pointer) || this.isOther(pointer);
  }

  /** A first finger says that no other one touches any more, whatever was told of the one before. */
  private isStale({ pointerType, isPrimary }: Pointer): boolean {
    return pointerType === "touch" && isPrimary === true && this.holder?.pointer.pointerType === "touch";
  }

  private isOther({ pointerId }: Pointer): boolean {
    return this.holder !== null && this.holder.pointer.pointerId !== pointerId;
  }

  /** Who has a pen rests his hand on the screen: for good, since it touches at any time, and often before the pen does. */
  isPalm({ pointerType }: Pointer): boolean {
    this.knowsPen ||= pointerType === "pen";
    return pointerType === "touch" && this.knowsPen;
  }
}
