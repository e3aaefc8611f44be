# SPDX-License-Identifier: Apache-2.0
"""What every conftest.py shares: a file that skips as a whole leaves pytest with nothing collected, for which it ends with 5, and
CTest takes that for a failure. Where something said that it was skipped it is none."""


def pytest_sessionfinish(session, exitstatus):
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if exitstatus == 5 and reporter and reporter.stats.get("skipped"):
        session.exitstatus = 0
