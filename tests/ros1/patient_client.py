# SPDX-License-Identifier: Apache-2.0
"""The stock action client without its race: an answer that comes before send_goal has returned is lost there (actionlib, issue 206)."""
import threading

import actionlib


class PatientClient(actionlib.SimpleActionClient):
    def __init__(self, name, action):
        self.sending = threading.RLock()
        super().__init__(name, action)

    def send_goal(self, *arguments, **named):
        with self.sending:
            super().send_goal(*arguments, **named)

    def _handle_transition(self, handle):
        with self.sending:
            super()._handle_transition(handle)
