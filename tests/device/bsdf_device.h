/* bsdf_device.h: the surface models on the device, one at a time, for tests that run one table of
 * cases (bsdf_models.h) through the kernels of bsdf.cl. */
#ifndef CANDELA_TESTS_BSDF_DEVICE_H
#define CANDELA_TESTS_BSDF_DEVICE_H

#include <stddef.h>

#include "tests/device/bsdf_models.h"
#include "tests/device/bsdf_setup.h"
#include "tests/device/harness.h"

/* cmocka's set-up and tear-down of a group: opens the device, says its name, makes the tables of
 * lost energy. */
int bsdf_device_open(void **state);
int bsdf_device_close(void **state);

/* 1 where CDL_SOAK asks for a long run. */
int bsdf_is_soak(void);

/* What the case's model has at a point, for the host; and for the device, seen from wo. */
BsdfPoint bsdf_point_of(const BsdfCase *c);
BsdfSetup bsdf_setup_of(const BsdfCase *c, vec3 wo, uint seed);

/* Runs a kernel of bsdf.cl built for the case's model over `items`, a multiple of BSDF_STRIP. Its
 * arguments are the setup, the case's words, the tables, and the given buffers. */
void bsdf_run(const BsdfCase *c, const char *kernel, size_t items, BsdfSetup *setup,
              const HarnessBuffer *buffers, size_t count);

/* The same with `params`, words of many parameter sets, in the place of the case's. */
void bsdf_run_with(const BsdfCase *c, const char *kernel, size_t items, BsdfSetup *setup,
                   HarnessBuffer params, const HarnessBuffer *buffers, size_t count);

/* Fails the test with what BSDF_FAULT_* of an item say. */
void bsdf_name_faults(const BsdfCase *c, const char *what, size_t item, uint faults);

#endif
