--  SPDX-FileCopyrightText: Ravenchart contributors
--  SPDX-License-Identifier: Apache-2.0

--  Where a program without a run-time library writes its lines.

package Lines is

   procedure Put (C : Character);
   --  Write a character.

end Lines;
