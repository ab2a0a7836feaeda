// SPDX-License-Identifier: BSD-3-Clause
/// @file DeviceTimer.h
/// @brief Time that a GPU itself works, beside the elapsed time of Measuring.h.
#pragma once

#include "vtk_glew.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <initializer_list>

/// A timer query. Keeps the device busy until all that is to be timed stands in line, so that the
/// time in which it would wait for the processor does not count. Made, used and deleted with a
/// context current; queries of others must not run between Start and Stop.
class DeviceTimer
{
public:
  DeviceTimer()
  {
    // Software renderers put work off, so that queries tell nothing of them.
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (!GLEW_ARB_timer_query || !renderer || std::strstr(renderer, "llvmpipe"))
    {
      return;
    }
    glGenQueries(1, &this->Query);
    glGenBuffers(2, this->Buffers);
    this->Bind();
    for (const GLenum target : { GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER })
    {
      glBufferData(target, Bytes, nullptr, GL_STATIC_COPY);
    }
    for (int i = 0; i < 3; ++i) // the first of them allocate
    {
      glFinish();
      const auto start = std::chrono::steady_clock::now();
      this->Copy(16);
      glFinish();
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      this->CopySeconds = taken.count() / 16.0;
    }
  }
  ~DeviceTimer()
  {
    if (this->Query)
    {
      glDeleteQueries(1, &this->Query);
      glDeleteBuffers(2, this->Buffers);
    }
  }
  DeviceTimer(const DeviceTimer&) = delete;
  DeviceTimer& operator=(const DeviceTimer&) = delete;

  /// Whether the device tells its time; what follows does nothing otherwise.
  bool IsAvailable() const { return this->Query != 0; }

  /// `ahead`: seconds that the processor takes to ask for what is to be timed.
  void Start(double ahead)
  {
    if (this->Query)
    {
      this->Bind();
      this->Copy(1 + int(std::ceil(1.5 * ahead / this->CopySeconds)));
      glBeginQuery(GL_TIME_ELAPSED, this->Query);
    }
  }

  /// Seconds since Start; waits for the device. 0 if it does not tell.
  double Stop()
  {
    GLuint64 nanoseconds = 0;
    if (this->Query)
    {
      glEndQuery(GL_TIME_ELAPSED);
      glGetQueryObjectui64v(this->Query, GL_QUERY_RESULT, &nanoseconds);
    }
    return 1e-9 * double(nanoseconds);
  }

private:
  void Bind() const
  {
    glBindBuffer(GL_COPY_READ_BUFFER, this->Buffers[0]);
    glBindBuffer(GL_COPY_WRITE_BUFFER, this->Buffers[1]);
  }
  static void Copy(int times)
  {
    for (int i = 0; i < times; ++i)
    {
      glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, Bytes);
    }
  }

  static constexpr GLsizeiptr Bytes = GLsizeiptr(256) << 20;
  GLuint Query = 0;
  GLuint Buffers[2] = { 0, 0 };
  double CopySeconds = 1.0;
};
