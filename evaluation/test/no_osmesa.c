/* SPDX-License-Identifier: BSD-3-Clause
 * Preloaded by a test: a machine on which OSMesa can make no context. */
void* OSMesaCreateContextExt(unsigned format, int depth, int stencil, int accumulation,
                             void* share) {
  (void)format, (void)depth, (void)stencil, (void)accumulation, (void)share;
  return 0;
}
