/* cl.h: the one place that includes OpenCL. Candela uses version 1.2 of the interface, nothing
 * later, so that every platform of the last decade can run it. */
#ifndef CANDELA_DEVICE_CL_H
#define CANDELA_DEVICE_CL_H

#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>

/* The name of an OpenCL status, "CL_OUT_OF_RESOURCES"; never NULL. Codes that no header names come
 * back as "OpenCL error". */
const char *cl_error_name(cl_int code);

#endif
