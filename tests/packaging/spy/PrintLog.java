// Reads a log of lcm-logger with the types on the class path, which it finds the same way as lcm-spy, and prints every
// event as "<channel> <type>" and each body of a response as "wrench <utime> <body_id> <fx> <fy> <fz>". Exits with 1
// if the type of a message is not on the class path.
import java.io.DataInput;
import java.io.EOFException;
import java.nio.ByteBuffer;

import lcm.lcm.LCMDataInputStream;
import lcm.logging.Log;
import lcm.spy.LCMTypeDatabase;

public class PrintLog {
  public static void main(String[] arguments) throws Exception {
    LCMTypeDatabase types = new LCMTypeDatabase();
    Log log = new Log(arguments[0], "r");
    while (true) {
      Log.Event event;
      try {
        event = log.readNext();
      } catch (EOFException end) {
        return;
      }
      Class<?> type = types.getClassByFingerprint(ByteBuffer.wrap(event.data).getLong());
      if (type == null) {
        System.err.println(event.channel + ": no type on the class path has this message's fingerprint");
        System.exit(1);
      }
      System.out.println(event.channel + " " + type.getName());
      Object message = type.getConstructor(DataInput.class).newInstance(new LCMDataInputStream(event.data));
      if (!(message instanceof buoyancy.body_wrenches_t)) continue;
      buoyancy.body_wrenches_t response = (buoyancy.body_wrenches_t) message;
      for (buoyancy.body_wrench_t body : response.bodies) {
        System.out.println(
            "wrench " + response.utime + " " + body.body_id
                + " " + body.force[0] + " " + body.force[1] + " " + body.force[2]);
      }
    }
  }
}
