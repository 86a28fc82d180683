# The calls that failing_calls.c stands in for.
set(SKG_WRAPPED malloc calloc realloc free json_loads json_loadb
  clCreateContext clCreateCommandQueue clCreateProgramWithSource clCreateKernel clCreateBuffer clBuildProgram
  clSetKernelArg clGetPlatformIDs clGetPlatformInfo clGetDeviceIDs clGetDeviceInfo clGetEventProfilingInfo
  clGetKernelInfo clGetMemObjectInfo clFlush clFinish clWaitForEvents clEnqueueNDRangeKernel clEnqueueFillBuffer
  clEnqueueReadBuffer clEnqueueReadBufferRect clEnqueueWriteBuffer clEnqueueBarrierWithWaitList
  clEnqueueMarkerWithWaitList clReleaseContext clReleaseCommandQueue clReleaseProgram clReleaseKernel
  clReleaseMemObject clReleaseEvent)
list(TRANSFORM SKG_WRAPPED PREPEND -Wl,--wrap=)
